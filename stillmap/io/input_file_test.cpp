// SPDX-License-Identifier: Apache-2.0
#include "stillmap/io/input_file.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "stillmap/core/error.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "tests/support/files.hpp"

namespace stillmap {
namespace {

TEST(InputFile, ReadsAnyPart) {
  const TemporaryFolder folder;
  write_file_atomically(folder.path() / "a", std::string("01\0 4567", 8));
  const InputFile file(folder.path() / "a");
  EXPECT_EQ(file.size(), 8U);
  EXPECT_EQ(file.read(4, 3), "456");
  EXPECT_EQ(file.read(0, 8), std::string("01\0 4567", 8));
  EXPECT_EQ(file.read(8, 0), "");
  EXPECT_THROW((void)file.read(6, 3), Error);
}

TEST(InputFile, RefusesWhatIsNoFile) {
  const TemporaryFolder folder;
  EXPECT_THROW(InputFile(folder.path() / "none"), Error);
  EXPECT_THROW(InputFile(folder.path()), Error);
  EXPECT_THROW(InputFile("/dev/null"), Error);
  const std::filesystem::path pipe = folder.path() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THROW(InputFile{pipe}, Error);
}

}  // namespace
}  // namespace stillmap
