// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace stillmap {

// What the build was configured with. The values are in version.cpp.in, so that a commit compiles
// that file alone.
extern const std::string_view kVersion;
extern const std::string_view kCommit;  // empty when not known
extern const std::string_view kLibraryVersions;
extern const std::string_view kCompiler;

}  // namespace stillmap
