// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace stillmap {

struct Outcome {
  int exit_code = -1;
  std::string out;
  std::string err;
};

class Cli : public testing::Test {
 protected:
  Cli() {
    const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() /
              ("stillmap_cli_" + std::string(test->name()) + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
  }
  ~Cli() override { std::filesystem::remove_all(folder_); }

  // Runs "stillmap ARGUMENTS" in a shell, in the test's folder, without networks that are installed
  // on this machine; `environment` is of the form NAME=VALUE.
  [[nodiscard]] Outcome run(const std::string& arguments,
                            const std::string& environment = "") const {
    const std::string command = "cd '" + folder_.string() + "' && export STILLMAP_MODELS=none; " +
                                environment + " '" STILLMAP_BINARY_DIR "/bin/stillmap' " +
                                arguments;
    const int status = std::system(
        ("{ " + command + "; } > " + path("stdout.txt") + " 2> " + path("stderr.txt")).c_str());
    return {
        WIFEXITED(status) ? WEXITSTATUS(status) : -1, content("stdout.txt"), content("stderr.txt")};
  }

  // Expects exit code 2, nothing on standard output, and one line of error that contains `part`.
  void expect_refused(const std::string& arguments, const std::string& part) const {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments;
    EXPECT_EQ(outcome.out, "") << arguments;
    EXPECT_THAT(outcome.err, testing::MatchesRegex("stillmap: [^\n]*\n")) << arguments;
    EXPECT_THAT(outcome.err, testing::HasSubstr(part)) << arguments;
  }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }

  [[nodiscard]] std::string path(const std::string& name) const {
    return "'" + (folder_ / name).string() + "'";
  }

  [[nodiscard]] std::string content(const std::string& name) const {
    std::ostringstream text;
    text << std::ifstream(folder_ / name).rdbuf();
    return text.str();
  }

  std::filesystem::path folder_;
};

}  // namespace stillmap
