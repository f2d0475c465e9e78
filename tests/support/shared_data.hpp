// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

namespace stillmap {

/// The path of recorded data by its name, such as "twin_walking_xyz/truth": in the folder named by
/// the variable STILLMAP_DATA, else in ../shared/data beside the repository. It need not exist.
[[nodiscard]] inline std::filesystem::path shared_data(const std::string& name) {
  const char* variable = std::getenv("STILLMAP_DATA");
  const std::filesystem::path folder =
      variable != nullptr ? std::filesystem::path(variable)
                          : std::filesystem::path(STILLMAP_SOURCE_DIR) / ".." / "shared" / "data";
  return folder / name;
}

}  // namespace stillmap

/// Skips the test, or all tests of a fixture in its SetUp, where this recorded data is absent.
#define STILLMAP_NEED_SHARED_DATA(name)                        \
  if (!std::filesystem::exists(::stillmap::shared_data(name))) \
  GTEST_SKIP() << ::stillmap::shared_data(name)                \
               << " is not there: set STILLMAP_DATA to the folder that holds it"
