// SPDX-License-Identifier: Apache-2.0
// Ctrl-C and SIGTERM, sent to the program while it reads a frame that the test holds back.
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>

#include "tests/support/cli_fixture.hpp"
#include "tests/support/plane_sequence.hpp"

namespace stillmap {
namespace {

using testing::HasSubstr;

class Interruption : public Cli {
 protected:
  static constexpr int kFrames = 40, kHeld = 20;

  Interruption() {
    write_plane_sequence(folder_ / "wall", kFrames);
    held_ = folder_ / "wall" / "rgb" / fmt::format("{:.6f}.png", 100 + kHeld / 30.0);
    std::ostringstream bytes;
    bytes << std::ifstream(held_).rdbuf();
    image_ = bytes.str();
  }

  // Starts "stillmap run wall ..." and returns when it reads the image that is held back. The image
  // is a pipe, which can be opened for writing only when it is being read.
  void start(const std::vector<std::string>& options) {
    std::filesystem::remove(held_);
    ASSERT_EQ(mkfifo(held_.c_str(), 0600), 0);
    const std::string program = STILLMAP_BINARY_DIR "/bin/stillmap";
    std::vector<std::string> arguments = {program, "run", "wall"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const std::string out = (folder_ / "stdout.txt").string();
    const std::string err = (folder_ / "stderr.txt").string();
    child_ = fork();
    if (child_ == 0) {
      // Shells have programs in the background ignore Ctrl-C.
      std::signal(SIGINT, SIG_DFL);
      std::signal(SIGTERM, SIG_DFL);
      std::vector<char*> argv;
      for (std::string& argument : arguments) argv.push_back(argument.data());
      argv.push_back(nullptr);
      const bool ready = chdir(folder_.c_str()) == 0 && setenv("STILLMAP_MODELS", "none", 1) == 0 &&
                         freopen(out.c_str(), "w", stdout) != nullptr &&
                         freopen(err.c_str(), "w", stderr) != nullptr;
      if (ready) execv(program.c_str(), argv.data());
      _exit(127);
    }
    pipe_ = open(held_.c_str(), O_WRONLY | O_CLOEXEC);
    ASSERT_GE(pipe_, 0);
  }

  // Sends a signal and returns when the program has noted it: from then on a second one has its
  // usual effect, which the system tells.
  void interrupt(int signal_number) const {
    ASSERT_EQ(kill(child_, signal_number), 0);
    const std::string status = "/proc/" + std::to_string(child_) + "/status";
    for (bool noted = false; !noted; std::this_thread::yield()) {
      std::ifstream lines(status);
      for (std::string line; std::getline(lines, line);) {
        if (!line.starts_with("SigCgt:")) continue;
        const auto caught = std::stoull(line.substr(7), nullptr, 16);
        noted = (caught & (1ULL << (SIGINT - 1) | 1ULL << (SIGTERM - 1))) == 0;
      }
    }
  }

  void give_image() const {
    ASSERT_EQ(write_all(pipe_, image_), image_.size());
    close(pipe_);
  }

  // The status of the program at its end.
  [[nodiscard]] int wait_for_end() const {
    int status = 0;
    waitpid(child_, &status, 0);
    return status;
  }

  void restore_image() const {
    std::filesystem::remove(held_);
    std::ofstream(held_) << image_;
  }

  static std::size_t write_all(int file, const std::string& bytes) {
    std::size_t done = 0;
    while (done < bytes.size()) {
      const ssize_t count = ::write(file, bytes.data() + done, bytes.size() - done);
      if (count <= 0) break;
      done += static_cast<std::size_t>(count);
    }
    return done;
  }

  std::filesystem::path held_;
  std::string image_;
  pid_t child_ = 0;
  int pipe_ = -1;
};

TEST_F(Interruption, EndsARunAsIfTheSequenceHadEnded) {
  ASSERT_EQ(run(fmt::format("run wall --out short --frames 0:{}", kHeld + 1)).exit_code, 0);
  for (const int signal_number : {SIGINT, SIGTERM}) {
    start({"--out", "out"});
    interrupt(signal_number);
    give_image();
    const int status = wait_for_end();
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 4);
    for (const char* file : {"trajectory.txt", "keyframes.txt", "map.ply", "map.stillmap"}) {
      EXPECT_EQ(content(std::string("out/") + file), content(std::string("short/") + file)) << file;
    }
    const nlohmann::json report = nlohmann::json::parse(content("out/report.json"));
    EXPECT_EQ(report["frames"]["total"], kHeld + 1);
    EXPECT_EQ(report["frames"]["tracked"], kHeld + 1);
    EXPECT_THAT(content("stderr.txt"), HasSubstr("interrupted after 21 of 40 frames"));
    EXPECT_THAT(content("stdout.txt"), HasSubstr("tracked     21 of 21 frames"));
    std::filesystem::remove_all(folder_ / "out");
    restore_image();
  }
}

TEST_F(Interruption, ASecondSignalEndsTheProgramAtOnce) {
  start({"--out", "out"});
  interrupt(SIGINT);
  ASSERT_EQ(kill(child_, SIGTERM), 0);
  const int status = wait_for_end();
  close(pipe_);
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(WTERMSIG(status), SIGTERM);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out" / "trajectory.txt"));
}

TEST_F(Interruption, OfALiveRunCanBeReplayed) {
  start({"--out", "out", "--live", "--speed", "0.5"});
  interrupt(SIGINT);
  give_image();
  EXPECT_EQ(WEXITSTATUS(wait_for_end()), 4);
  restore_image();
  EXPECT_EQ(run("run wall --out again --live --replay out/live.jsonl").exit_code, 0);
  EXPECT_EQ(content("again/trajectory.txt"), content("out/trajectory.txt"));
  EXPECT_EQ(content("again/map.ply"), content("out/map.ply"));
}

}  // namespace
}  // namespace stillmap
