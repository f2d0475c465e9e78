// SPDX-License-Identifier: Apache-2.0
#include "stillmap/io/atomic_file.hpp"

#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stillmap/core/error.hpp"
#include "tests/support/files.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

std::string content_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::size_t files_in(const fs::path& folder) {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(WriteFileAtomically, WritesAndReplacesAndLeavesNothingElse) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.bin";
  write_file_atomically(path, std::string("one\0two", 7));
  EXPECT_EQ(content_of(path), std::string("one\0two", 7));
  write_file_atomically(path, "");
  EXPECT_EQ(content_of(path), "");
  EXPECT_EQ(files_in(folder.path()), 1U);
}

TEST(WriteFileAtomically, FollowsALink) {
  const TemporaryFolder folder;
  write_file_atomically(folder.path() / "real", "old");
  fs::create_symlink("real", folder.path() / "link");
  write_file_atomically(folder.path() / "link", "new");
  EXPECT_TRUE(fs::is_symlink(folder.path() / "link"));
  EXPECT_EQ(content_of(folder.path() / "real"), "new");
}

TEST(AtomicFile, IsThereAsAWholeOrNotAtAll) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.bin";
  write_file_atomically(path, "old");
  {
    AtomicFile file(path);
    file.write("new, ");
    file.write("but given up");
    EXPECT_EQ(content_of(path), "old");
  }
  EXPECT_EQ(files_in(folder.path()), 1U);
  AtomicFile file(path);
  file.write("new, ");
  file.write(std::string("in\0two", 6));
  file.close();
  EXPECT_EQ(content_of(path), "old");
  file.take_place();
  EXPECT_EQ(content_of(path), "new, " + std::string("in\0two", 6));
  EXPECT_EQ(files_in(folder.path()), 1U);
  EXPECT_THROW(AtomicFile("/dev/null"), Error);
  EXPECT_THROW(AtomicFile(folder.path()), Error);
}

TEST(WriteFilesAtomically, WritesAll) {
  const TemporaryFolder folder;
  write_file_atomically(folder.path() / "a", "old");
  write_files_atomically(
      std::vector<FileContent>{{folder.path() / "a", "new"}, {folder.path() / "b", "b"}});
  EXPECT_EQ(content_of(folder.path() / "a"), "new");
  EXPECT_EQ(content_of(folder.path() / "b"), "b");
  EXPECT_EQ(files_in(folder.path()), 2U);
}

TEST(WriteFilesAtomically, WritesNoneWhenOneCannotBe) {
  const TemporaryFolder folder;
  const fs::path a = folder.path() / "a";
  const fs::path b = folder.path() / "b";
  write_file_atomically(a, "old");
  const std::string missing = (folder.path() / "none" / "c").string();
  EXPECT_THAT(
      error_of([&] {
        write_files_atomically(std::vector<FileContent>{{a, "new"}, {b, "b"}, {missing, "c"}});
      }),
      HasSubstr(missing));
  EXPECT_EQ(content_of(a), "old");
  EXPECT_EQ(files_in(folder.path()), 1U);
}

TEST(WriteFileAtomically, NamesTheFileWhenTheFolderIsMissing) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "none" / "a.txt";
  EXPECT_THAT(error_of([&] { write_file_atomically(path, "x"); }), HasSubstr(path.string()));
}

TEST(WriteFileAtomically, RefusesAFolder) {
  const TemporaryFolder folder;
  EXPECT_THAT(error_of([&] { write_file_atomically(folder.path(), "x"); }), HasSubstr("folder"));
  EXPECT_EQ(files_in(folder.path()), 0U);
}

TEST(WriteFileAtomically, SaysThatADiskIsFull) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  EXPECT_THAT(error_of([] { write_file_atomically("/dev/full", "x"); }), HasSubstr("/dev/full"));
  EXPECT_TRUE(fs::is_character_file("/dev/full"));  // still the device, not a file of that name
}

TEST(WriteFileAtomically, KeepsTheOldFileAndNoTemporaryOneWhenWritingFails) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.txt";
  write_file_atomically(path, "old");
  const FileSizeLimit limit(1000);
  EXPECT_THAT(error_of([&] { write_file_atomically(path, std::string(5000, 'x')); }),
              HasSubstr(path.string()));
  EXPECT_EQ(content_of(path), "old");
  EXPECT_EQ(files_in(folder.path()), 1U);
}

TEST(WriteFileAtomically, ThreadsOnOneFileLeaveOneWholeVersion) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.txt";
  {
    std::vector<std::jthread> threads;
    for (char c = 'a'; c < 'e'; ++c) {
      threads.emplace_back([&path, c] {
        for (int i = 0; i < 20; ++i) write_file_atomically(path, std::string(100000, c));
      });
    }
  }
  const std::string content = content_of(path);
  ASSERT_EQ(content.size(), 100000U);
  EXPECT_EQ(content, std::string(100000, content[0]));
  EXPECT_EQ(files_in(folder.path()), 1U);
}

TEST(ReadFile, ReadsAllBytes) {
  const TemporaryFolder folder;
  std::string bytes(200001, '\0');
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(i * 7);
  write_file_atomically(folder.path() / "a", bytes);
  EXPECT_EQ(read_file(folder.path() / "a", bytes.size()), bytes);
  write_file_atomically(folder.path() / "b", "");
  EXPECT_EQ(read_file(folder.path() / "b", 0), "");
}

TEST(ReadFile, ReadsWhatDoesNotTellItsSize) {
  EXPECT_THAT(read_file("/proc/self/status", 1000000), HasSubstr("VmSize"));
}

TEST(ReadFile, RefusesALargerFile) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "sparse";
  write_file_atomically(path, "x");
  fs::resize_file(path, std::uintmax_t{1} << 40U);
  EXPECT_THAT(error_of([&] { (void)read_file(path, 1000); }), HasSubstr("larger than 1000 bytes"));
  EXPECT_THAT(error_of([] { (void)read_file("/dev/zero", 1000); }), HasSubstr("larger than 1000"));
}

TEST(ReadFile, NamesWhatIsMissingOrAFolder) {
  const TemporaryFolder folder;
  EXPECT_THAT(error_of([&] { (void)read_file(folder.path() / "none", 10); }), HasSubstr("none"));
  EXPECT_THAT(error_of([&] { (void)read_file(folder.path(), 10); }), HasSubstr("folder"));
}

}  // namespace
}  // namespace stillmap
