// SPDX-License-Identifier: Apache-2.0
#include "stillmap/report/map_views.hpp"

#include <gtest/gtest.h>

namespace stillmap {
namespace {}  // namespace
}  // namespace stillmap
