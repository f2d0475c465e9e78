// SPDX-License-Identifier: Apache-2.0
#include "tooling/browser/scripts.hpp"

namespace stillmap {

#if !STILLMAP_WITH_THREE
std::string_view three_min_js() {
  return {};
}

std::string_view OrbitControls_js() {
  return {};
}
#endif

}  // namespace stillmap
