// SPDX-License-Identifier: Apache-2.0
#include "stillmap/io/input_files.hpp"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/files.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;

class InputFilesTest : public testing::Test {
 protected:
  InputFilesTest() {
    fs::create_directories(at("data/rgb"));
    std::ofstream(at("data/rgb.txt")) << "1 rgb/1.png\n";
    std::ofstream(at("map.ply")) << "ply";
    inputs_.add(at("data/rgb"));
    inputs_.add(at("data/rgb.txt"));
    inputs_.add(at("data/camera.yaml"));  // does not exist
    inputs_.add(at("map.ply"));
  }

  [[nodiscard]] fs::path at(const std::string& name) const { return folder_.path() / name; }
  void expect_refused(const fs::path& output) const {
    EXPECT_THAT(
        error_of([&] { inputs_.check_output("--out", output); }),
        testing::AllOf(testing::StartsWith("--out " + output.string() + ": this is the input "),
                       testing::HasSubstr("would be overwritten")));
  }
  void expect_allowed(const fs::path& output) const {
    EXPECT_NO_THROW(inputs_.check_output("--out", output)) << output;
  }

  TemporaryFolder folder_;
  InputFiles inputs_;
};

TEST_F(InputFilesTest, AreNeverOutputs) {
  expect_refused(at("map.ply"));
  expect_refused(at("data/rgb.txt"));
  expect_refused(at("data/camera.yaml"));
  expect_refused(at("data/rgb/new.png"));
  expect_refused(at("data/rgb/deep/er"));
  expect_refused(at("data/"));  // as a folder of which all is replaced
  expect_refused(at("data/x/../rgb.txt"));
  for (const char* other :
       {"map.pcd", "data/rgb2", "data/rgb.txt2", "data/result", "map.ply.bak"}) {
    expect_allowed(at(other));
  }
}

TEST_F(InputFilesTest, AreKnownByTheirOtherNames) {
  fs::create_directory_symlink(at("data"), at("link"));
  fs::create_symlink(at("map.ply"), at("same.ply"));
  fs::create_hard_link(at("map.ply"), at("twin.ply"));
  expect_refused(at("link/rgb.txt"));
  expect_refused(at("link/rgb/x"));
  expect_refused(at("link/camera.yaml"));
  expect_refused(at("same.ply"));
  expect_refused(at("twin.ply"));
  expect_allowed(at("link/result"));
}

}  // namespace
}  // namespace stillmap
