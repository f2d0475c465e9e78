// SPDX-License-Identifier: Apache-2.0
#include "stillmap/io/folder_replacement.hpp"

#include <fstream>
#include <map>
#include <sstream>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/support/files.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

using Content = std::map<std::string, std::string>;  // of each file, by its name

// Everything in a folder, hidden files included.
Content files_of(const fs::path& folder) {
  Content content;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_directory()) continue;
    std::ostringstream text;
    text << std::ifstream(entry.path()).rdbuf();
    content[entry.path().lexically_relative(folder).string()] = text.str();
  }
  return content;
}

void put(const fs::path& file, const std::string& text) {
  fs::create_directories(file.parent_path());
  std::ofstream(file) << text;
}

// The result has a.txt, b.txt and masks/N.png.
bool is_own(const fs::path& name) {
  return name == "a.txt" || name == "b.txt" ||
         (name.parent_path() == "masks" && name.extension() == ".png");
}

class FolderReplacementTest : public testing::Test {
 protected:
  FolderReplacementTest() {
    put(out_ / "a.txt", "old a");
    put(out_ / "b.txt", "old b");
    put(out_ / "masks/1.png", "old 1");
    put(out_ / "masks/notes.md", "foreign in an own folder");
    put(out_ / "deep/er/notes.txt", "foreign");
    put(out_ / "map.pcd", "foreign, too");
    fs::create_symlink("map.pcd", out_ / "link.pcd");
  }

  void replace(const fs::path& folder) const {
    FolderReplacement result(folder, is_own);
    write_new(result);
    EXPECT_EQ(without_stage(files_of(out_)), old_);
    result.take_place();
  }
  static void write_new(const FolderReplacement& result) {
    result.write("a.txt", "new a");
    result.write("masks/2.png", [](const FolderReplacement::Sink& sink) {
      sink("new");
      sink(" 2");
    });
  }
  static Content without_stage(Content content) {
    std::erase_if(content,
                  [](const auto& file) { return file.first.starts_with(".stillmap-new"); });
    return content;
  }
  // Nothing but the folder is left beside it.
  void expect_only_out() const {
    for (const auto& entry : fs::directory_iterator(folder_.path())) {
      EXPECT_EQ(entry.path(), out_);
    }
  }

  TemporaryFolder folder_;
  fs::path out_ = folder_.path() / "out";
  const Content foreign_ = {{"masks/notes.md", "foreign in an own folder"},
                            {"deep/er/notes.txt", "foreign"},
                            {"map.pcd", "foreign, too"},
                            {"link.pcd", "foreign, too"}};
  const Content old_ =
      with(foreign_, {{"a.txt", "old a"}, {"b.txt", "old b"}, {"masks/1.png", "old 1"}});
  const Content new_ = with(foreign_, {{"a.txt", "new a"}, {"masks/2.png", "new 2"}});

  static Content with(Content content, const Content& more) {
    content.insert(more.begin(), more.end());
    return content;
  }
};

TEST_F(FolderReplacementTest, ReplacesAllAndKeepsWhatIsForeign) {
  ASSERT_EQ(files_of(out_), old_);
  fs::permissions(out_, fs::perms::owner_all | fs::perms::group_read);
  struct stat notes = {}, folder = {};
  ASSERT_EQ(::stat((out_ / "deep/er/notes.txt").c_str(), &notes), 0);
  ASSERT_EQ(::stat(out_.c_str(), &folder), 0);
  replace(out_);
  EXPECT_EQ(files_of(out_), new_);
  EXPECT_TRUE(fs::is_symlink(out_ / "link.pcd"));
  expect_only_out();
  struct stat after = {};
  ASSERT_EQ(::stat((out_ / "deep/er/notes.txt").c_str(), &after), 0);
  EXPECT_EQ(after.st_ino, notes.st_ino);  // the same file, not a copy
  ASSERT_EQ(::stat(out_.c_str(), &after), 0);
  EXPECT_NE(after.st_ino, folder.st_ino);  // exchanged
  EXPECT_EQ(after.st_mode, folder.st_mode);
}

TEST_F(FolderReplacementTest, FollowsALinkToTheFolder) {
  fs::create_directory_symlink(out_, folder_.path() / "link");
  replace(folder_.path() / "link/");
  EXPECT_TRUE(fs::is_symlink(folder_.path() / "link"));
  EXPECT_EQ(files_of(out_), new_);
}

TEST_F(FolderReplacementTest, MakesANewFolder) {
  const fs::path made = folder_.path() / "deep/new";
  {
    FolderReplacement result(made, is_own);
    EXPECT_TRUE(is_vacant(made));
    write_new(result);
    EXPECT_TRUE(is_vacant(made));
    result.take_place();
  }
  EXPECT_EQ(files_of(made), (Content{{"a.txt", "new a"}, {"masks/2.png", "new 2"}}));
  EXPECT_FALSE(is_vacant(made));
  EXPECT_TRUE(is_vacant(folder_.path() / "none"));
}

// The working folder cannot be exchanged.
TEST_F(FolderReplacementTest, ReplacesTheWorkingFoldersFilesOneByOne) {
  const fs::path before = fs::current_path();
  fs::current_path(out_ / "deep");
  struct stat folder = {}, after = {};
  ASSERT_EQ(::stat(out_.c_str(), &folder), 0);
  replace("..");
  ASSERT_EQ(::stat(out_.c_str(), &after), 0);
  fs::current_path(before);
  EXPECT_EQ(after.st_ino, folder.st_ino);
  EXPECT_EQ(files_of(out_), new_);
  expect_only_out();
}

TEST_F(FolderReplacementTest, LeavesTheOldWhenGivenUp) {
  {
    const FolderReplacement result(out_, is_own);
    write_new(result);
  }
  EXPECT_EQ(files_of(out_), old_);
  {
    const FolderReplacement result(out_, is_own);
    result.write("a.txt", "new a");
    const FileSizeLimit limit(1000);
    EXPECT_EQ(error_of([&] { result.write("b.txt", std::string(5000, 'x')); }),
              "cannot write " + (out_ / "b.txt").string() + ": File too large");
  }
  EXPECT_EQ(files_of(out_), old_);
  expect_only_out();
}

TEST_F(FolderReplacementTest, NeverReplacesAFolderByAFile) {
  fs::remove(out_ / "a.txt");
  put(out_ / "a.txt/precious", "of somebody");
  FolderReplacement result(out_, is_own);
  write_new(result);
  EXPECT_THAT(error_of([&] { result.take_place(); }), HasSubstr("a.txt: Is a directory"));
  EXPECT_EQ(without_stage(files_of(out_)).at("a.txt/precious"), "of somebody");
}

TEST_F(FolderReplacementTest, IsForOneAtATime) {
  FolderReplacement first(out_, is_own);
  EXPECT_THAT(error_of([&] { const FolderReplacement second(out_, is_own); }),
              HasSubstr("another process is writing results"));
  write_new(first);
  first.take_place();
  EXPECT_EQ(files_of(out_), new_);
}

// What a killed process leaves: new files that took no place, or old ones after the exchange, with
// foreign files that came into the old folder while it was exchanged.
TEST_F(FolderReplacementTest, SettlesWhatAKilledProcessLeft) {
  put(out_ / ".stillmap-new/a.txt", "half");
  put(out_ / ".stillmap-new/masks/9.png", "half");
  put(folder_.path() / ".out.stillmap-new/b.txt", "replaced");
  put(folder_.path() / ".out.stillmap-new/late/photo.jpg", "came late");
  fs::create_hard_link(out_ / "map.pcd", folder_.path() / ".out.stillmap-new/map.pcd");
  { const FolderReplacement result(out_, is_own); }
  EXPECT_EQ(files_of(out_), with(old_, {{"late/photo.jpg", "came late"}}));
  expect_only_out();
}

TEST_F(FolderReplacementTest, SaysWhereItCannotWrite) {
  put(folder_.path() / "file", "");
  EXPECT_THAT(error_of([&] { const FolderReplacement result(folder_.path() / "file", is_own); }),
              HasSubstr("file: the folder cannot be made"));
  EXPECT_THAT(error_of([&] { const FolderReplacement result("/proc/results", is_own); }),
              HasSubstr("/proc/results"));
}

TEST_F(FolderReplacementTest, IsWrittenByManyThreads) {
  FolderReplacement result(out_, is_own);
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&, t] {
      for (int i = 0; i < 25; ++i) {
        const std::string name = std::to_string(100 * t + i);
        result.write("masks/" + name + ".png", name);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  result.take_place();
  const Content content = files_of(out_);
  EXPECT_EQ(content.size(), foreign_.size() + 100);
  EXPECT_EQ(content.at("masks/324.png"), "324");
}

}  // namespace
}  // namespace stillmap
