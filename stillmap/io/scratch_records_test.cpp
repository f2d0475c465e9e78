// SPDX-License-Identifier: Apache-2.0
#include "stillmap/io/scratch_records.hpp"

#include <cstdlib>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "stillmap/core/error.hpp"
#include "tests/support/files.hpp"

namespace stillmap {
namespace {

/// TMPDIR for the life of the object.
class TemporaryFilesIn {
 public:
  explicit TemporaryFilesIn(const std::filesystem::path& folder) {
    if (const char* const before = std::getenv("TMPDIR")) before_ = before;
    ::setenv("TMPDIR", folder.c_str(), 1);
  }
  TemporaryFilesIn(const TemporaryFilesIn&) = delete;
  TemporaryFilesIn& operator=(const TemporaryFilesIn&) = delete;
  ~TemporaryFilesIn() {
    before_.empty() ? ::unsetenv("TMPDIR") : ::setenv("TMPDIR", before_.c_str(), 1);
  }

 private:
  std::string before_;
};

std::vector<std::string> all(const ScratchRecords& records) {
  std::vector<std::string> found;
  records.visit([&](std::string_view record) { found.emplace_back(record); });
  return found;
}

TEST(ScratchRecords, GivesBackWhatItWasGiven) {
  ScratchRecords records;
  EXPECT_TRUE(all(records).empty());
  std::mt19937 rng(3);
  std::vector<std::string> given;
  for (int i = 0; i < 3000; ++i) {
    given.emplace_back(rng() % 500, static_cast<char>(rng()));
    if (i == 1500) given.back() = std::string(300000, 'x');  // longer than any buffer
    records.push_back(given.back());
    EXPECT_LT(records.buffered(), 70000U) << "the rest is on the disk";
  }
  EXPECT_EQ(all(records), given);
  EXPECT_EQ(all(records), given) << "a second time";
  records.push_back("more");
  given.emplace_back("more");
  EXPECT_EQ(all(records), given);
}

TEST(ScratchRecords, LeavesNoName) {
  const TemporaryFolder folder;
  const TemporaryFilesIn tmpdir(folder.path());
  ScratchRecords records;
  records.push_back(std::string(100000, 'x'));
  EXPECT_EQ(records.buffered(), 0U);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(ScratchRecords, SaysWhereNothingCanBeWritten) {
  const TemporaryFilesIn tmpdir("/proc/self/fdinfo");
  ScratchRecords records;
  try {
    records.push_back(std::string(100000, 'x'));
    FAIL() << "/proc takes no files";
  } catch (const Error& error) {
    EXPECT_NE(std::string_view(error.what()).find("/proc/self/fdinfo"), std::string_view::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace stillmap
