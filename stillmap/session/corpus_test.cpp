// SPDX-License-Identifier: Apache-2.0
// What fuzzing has found and started from, in every build. Files whose name begins with "valid" are
// sessions; of the others nobody knows.
#include <algorithm>
#include <filesystem>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stillmap/core/error.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "stillmap/session/session_io.hpp"
#include "stillmap/session/session_map.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> corpus() {
  std::vector<fs::path> files;
  for (const auto& entry :
       fs::directory_iterator(fs::path(STILLMAP_SOURCE_DIR) / "fuzz" / "corpus" / "session")) {
    files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

TEST(SessionCorpus, IsReadOrRefusedWithOneLine) {
  int valid = 0;
  for (const fs::path& file : corpus()) {
    SCOPED_TRACE(file.filename().string());
    const bool is_valid = file.filename().string().starts_with("valid");
    valid += is_valid ? 1 : 0;
    const std::string bytes = read_file(file, std::size_t{1} << 20U);
    try {
      const Session session = decode_session(bytes, "x");
      session.map.check_consistency();
      EXPECT_EQ(encode_session(session), bytes);
      for (const SubmapId submap : session.map.submaps()) {
        EXPECT_LE(trajectory_in(session, submap).size(), session.frames.size());
      }
    } catch (const Error& error) {
      EXPECT_FALSE(is_valid) << error.what();
      EXPECT_THAT(error.what(), testing::MatchesRegex("x: [ -~]*"));
    }
  }
  EXPECT_GE(valid, 3);
}

}  // namespace
}  // namespace stillmap
