// SPDX-License-Identifier: Apache-2.0
// Ctrl-C and SIGTERM, sent to the program in the middle of a live run.
#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <poll.h>
#include <sys/inotify.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/cli_fixture.hpp"
#include "tests/support/plane_sequence.hpp"
#include "tooling/devices/openni_device.hpp"

#if STILLMAP_WITH_FAKE_ROSBRIDGE
#include "tests/support/rosbridge/fake_rosbridge.hpp"
#endif

namespace stillmap {
namespace {

using testing::HasSubstr;
using testing::Not;

class Interruption : public Cli {
 protected:
  Interruption() { write_plane_sequence(folder_ / "wall", 40); }

  // "stillmap run wall --live" at a quarter of the speed: five seconds in all.
  static inline const std::vector<std::string> kSlowRun = {
      "run", "wall", "--live", "--speed", "0.25", "--out", "out"};

  // Starts a run of the program and returns when some frames have been taken: a second after the
  // results' folder has been begun.
  void start(const std::vector<std::string>& options) {
    const int watch = inotify_init1(IN_CLOEXEC);
    ASSERT_GE(inotify_add_watch(watch, folder_.c_str(), IN_CREATE), 0);
    const std::string program = STILLMAP_BINARY_DIR "/bin/stillmap";
    std::vector<std::string> arguments = {program};
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
    bool begun = false;
    while (!begun) {
      pollfd ready{watch, POLLIN, 0};
      ASSERT_EQ(poll(&ready, 1, 30'000), 1) << "no folder for results: " << content("stderr.txt");
      alignas(inotify_event) std::array<char, 4096> events{};
      const ssize_t size = read(watch, events.data(), events.size());
      for (ssize_t at = 0; at < size;) {
        const auto* event = reinterpret_cast<const inotify_event*>(events.data() + at);
        begun = begun || !std::string_view(event->name).ends_with(".txt");
        at += static_cast<ssize_t>(sizeof(inotify_event)) + event->len;
      }
    }
    close(watch);
    std::this_thread::sleep_for(std::chrono::seconds(1));
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

  // The status of the program at its end.
  [[nodiscard]] int wait_for_end() const {
    int status = 0;
    waitpid(child_, &status, 0);
    return status;
  }

  pid_t child_ = 0;
};

TEST_F(Interruption, EndsARunAsIfTheSequenceHadEnded) {
  for (const int signal_number : {SIGINT, SIGTERM}) {
    start(kSlowRun);
    interrupt(signal_number);
    const int status = wait_for_end();
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 4);
    const nlohmann::json report = nlohmann::json::parse(content("out/report.json"));
    const int frames = report["frames"]["total"];
    EXPECT_LT(frames, 40);
    EXPECT_EQ(report["frames"]["tracked"], frames);
    EXPECT_THAT(content("stderr.txt"),
                HasSubstr(fmt::format("interrupted after {} of 40 frames", frames)));
    ASSERT_EQ(run("run wall --out again --live --replay out/live.jsonl").exit_code, 0);
    for (const char* file : {"trajectory.txt", "keyframes.txt", "map.ply"}) {
      EXPECT_EQ(content(std::string("out/") + file), content(std::string("again/") + file)) << file;
    }
    EXPECT_TRUE(std::filesystem::exists(folder_ / "out" / "map.stillmap"));
    std::filesystem::remove_all(folder_ / "out");
  }
}

// A camera's frames have no other end, so that this one is no interruption (exit code 4). OpenNI2's
// own device without hardware gives hardly any depth: nothing is tracked (exit code 3).
TEST_F(Interruption, IsTheEndOfARunOnADevice) {
  if (!has_openni()) GTEST_SKIP() << "built without libopenni2-dev";
  write("camera.yaml", "width: 320\nheight: 240\nfx: 280\nfy: 280\ncx: 160\ncy: 120\n");
  start({"run",
         "--device",
         "openni2:Dummy",
         "--camera",
         "camera.yaml",
         "--out",
         "out",
         "--save-recording",
         "kept"});
  interrupt(SIGINT);
  const int status = wait_for_end();
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 3) << content("stderr.txt");
  EXPECT_THAT(content("stderr.txt"), Not(HasSubstr("interrupted")));
  const std::string record = content("out/live.jsonl");
  const auto taken = std::ranges::count(record, '\n');
  EXPECT_GT(taken, 3);
  EXPECT_THAT(content("stdout.txt"), HasSubstr("input       openni2:Dummy, 320x240"));
  EXPECT_THAT(content("stdout.txt"), HasSubstr("frames in kept"));
  ASSERT_EQ(run("run kept --out again --live --replay out/live.jsonl").exit_code, 3);
  EXPECT_EQ(content("again/live.jsonl"), record);
}

#if STILLMAP_WITH_FAKE_ROSBRIDGE

// The program on a robot, whose connection is lost in the middle. The robot sends a frame every 20
// ms of this test's time: the program may drop some.
TEST_F(Interruption, IsTheEndOfARunOnARobot) {
  const Sequence wall = Sequence::open(folder_ / "wall");
  FakeRosbridge robot(BridgeCoding::kCbor);
  robot.add_camera(wall);
  start({"run", "--device", "stream:" + robot.url(), "--out", "out", "--save-recording", "kept"});
  for (std::uint32_t i = 0; i < wall.size(); ++i) {
    if (i == wall.size() / 2) {
      robot.go_down();
      std::this_thread::sleep_for(std::chrono::milliseconds(1500));
      robot.come_up();
    }
    robot.publish_frame(wall, i);
    std::this_thread::sleep_for(std::chrono::milliseconds(i % 20 == 0 ? 1500 : 20));
  }
  std::this_thread::sleep_for(std::chrono::seconds(1));
  interrupt(SIGINT);
  const int status = wait_for_end();
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0) << content("stderr.txt");
  EXPECT_THAT(content("stderr.txt"), HasSubstr(robot.url() + " gives no images; waiting for it"));
  EXPECT_THAT(content("stderr.txt"), HasSubstr(robot.url() + " gives images again"));
  EXPECT_THAT(content("stdout.txt"),
              HasSubstr("input       stream:" + robot.url() +
                        ", 320x240; colour /camera/color/image_raw, depth "
                        "/camera/aligned_depth_to_color/image_raw\n"));
  const std::string record = content("out/live.jsonl");
  EXPECT_GT(std::ranges::count(record, '\n'), 10);
  ASSERT_EQ(run("run kept --out again --live --replay out/live.jsonl").exit_code, 0);
  for (const char* file : {"trajectory.txt", "keyframes.txt", "map.ply", "live.jsonl"}) {
    EXPECT_EQ(content(std::string("out/") + file), content(std::string("again/") + file)) << file;
  }
}

#endif

TEST_F(Interruption, ASecondSignalEndsTheProgramAtOnce) {
  start(kSlowRun);
  interrupt(SIGINT);
  ASSERT_EQ(kill(child_, SIGTERM), 0);
  const int status = wait_for_end();
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(WTERMSIG(status), SIGTERM);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out" / "trajectory.txt"));
}

}  // namespace
}  // namespace stillmap
