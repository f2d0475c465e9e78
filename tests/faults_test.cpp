// SPDX-License-Identifier: Apache-2.0
// Calls to the system that fail, and kills at any moment: one clear line, exit code 2, and in the
// folder of the results the old ones or the new ones, all of them.
#include <cstdlib>
#include <map>
#include <random>
#include <set>
#include <sstream>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stillmap/io/image_io.hpp"
#include "tests/support/cli_fixture.hpp"
#include "tests/support/plane_sequence.hpp"
#include "tooling/pipeline/run_folder.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::MatchesRegex;

using Content = std::map<std::string, std::string>;  // of each file, by its name

class Faults : public Cli {
 protected:
  static constexpr int kFrames = 3;
  Faults() { write_plane_sequence(folder_ / "wall", kFrames); }

  // Old results, of which every file says so, and a file of somebody else.
  void write_old() const {
    fs::create_directories(folder_ / "out/deep");
    for (const std::string_view name : run_file_names()) write("out/" + std::string(name), "old");
    write("out/deep/notes.txt", "foreign");
  }

  // All files in the folder, but for what waits for its place.
  [[nodiscard]] Content out() const {
    Content content;
    for (const auto& entry : fs::recursive_directory_iterator(folder_ / "out")) {
      const std::string name = entry.path().lexically_relative(folder_ / "out").string();
      if (entry.is_regular_file() && !name.starts_with(".stillmap-new")) {
        content[name] = this->content("out/" + name);
      }
    }
    return content;
  }

  // Whether the folder has new results; a failure where it has neither all new nor all old.
  [[nodiscard]] bool is_new() const {
    const Content content = out();
    EXPECT_EQ(content.count("deep/notes.txt"), 1U);
    std::set<std::string> old_names, new_names;
    for (const auto& [name, text] : content) {
      if (name != "deep/notes.txt") (text == "old" ? old_names : new_names).insert(name);
    }
    const std::set<std::string> all(run_file_names().begin(), run_file_names().end());
    std::set<std::string> of_run = all;
    of_run.erase("objects.jsonl");
    of_run.erase("live.jsonl");
    of_run.erase("movers.ply");
    EXPECT_TRUE((old_names == all && new_names.empty()) ||
                (new_names == of_run && old_names.empty()))
        << testing::PrintToString(old_names) << testing::PrintToString(new_names);
    return !new_names.empty();
  }

  // Nothing is left of results that took no place.
  void expect_tidy() const {
    EXPECT_FALSE(fs::exists(folder_ / "out/.stillmap-new"));
    EXPECT_FALSE(fs::exists(folder_ / ".out.stillmap-new"));
    for (const auto& entry : fs::directory_iterator(folder_)) {
      EXPECT_THAT(entry.path().filename().string(), testing::Not(HasSubstr(".tmp")));
    }
  }

  [[nodiscard]] Outcome run_with(const std::string& command, const std::string& variables) const {
    return run(command, variables + " LD_PRELOAD='" STILLMAP_FAILING_CALLS "'");
  }

  // How many calls, and large allocations, a command makes.
  [[nodiscard]] std::pair<long, long> counts_of(const std::string& command) const {
    EXPECT_EQ(run_with(command, "STILLMAP_COUNTS=counts.txt").exit_code, 0);
    std::istringstream text(content("counts.txt"));
    std::pair<long, long> counts;
    text >> counts.first >> counts.second;
    fs::remove(folder_ / "counts.txt");
    return counts;
  }

  // One clear line and exit code 2, or success in spite of the fault.
  static void expect_clear(const Outcome& outcome) {
    if (outcome.exit_code == 0) return;
    EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
    EXPECT_THAT(outcome.err, MatchesRegex("(stillmap: warning: [^\n]*\n)*stillmap: [^\n]*\n"));
    EXPECT_THAT(outcome.err, testing::Not(HasSubstr("internal error")));
  }

  [[nodiscard]] static int kills() {
    const char* const number = std::getenv("STILLMAP_TEST_KILLS");
    return number == nullptr ? 30 : std::atoi(number);
  }

  const std::string run_ = "run wall --out out --threads 1";
};

TEST_F(Faults, ARunReplacesAllOrNothingWhenACallFails) {
  write_old();
  const long calls = counts_of(run_).first;
  ASSERT_GT(calls, 40);
  int refused = 0;
  for (long n = 1; n <= calls; n += n < calls - 50 ? 9 : 3) {  // the last ones write
    SCOPED_TRACE(fmt::format("call {} of {}", n, calls));
    fs::remove_all(folder_ / "out");
    write_old();
    const Outcome outcome = run_with(run_, fmt::format("STILLMAP_FAIL_CALL={}", n));
    expect_clear(outcome);
    EXPECT_EQ(is_new(), outcome.exit_code == 0) << outcome.err;
    refused += outcome.exit_code == 0 ? 0 : 1;
  }
  EXPECT_GT(refused, 8);
  ASSERT_EQ(run(run_).exit_code, 0);
  EXPECT_TRUE(is_new());
  expect_tidy();
}

TEST_F(Faults, ARunWithTooLittleMemoryIsOneLine) {
  write_old();
  const long allocations = counts_of(run_).second;
  ASSERT_GT(allocations, 50);
  constexpr long kTrials = 12;
  int refused = 0;
  for (long trial = 0; trial < kTrials; ++trial) {
    const long n = 1 + trial * (allocations - 1) / (kTrials - 1);
    SCOPED_TRACE(fmt::format("allocation {} of {}", n, allocations));
    fs::remove_all(folder_ / "out");
    write_old();
    const Outcome outcome = run_with(run_, fmt::format("STILLMAP_FAIL_ALLOCATION={}", n));
    expect_clear(outcome);
    EXPECT_EQ(is_new(), outcome.exit_code == 0) << outcome.err;
    refused += outcome.exit_code == 0 ? 0 : 1;
  }
  EXPECT_GT(refused, 6);
}

TEST_F(Faults, ARunKilledAtACallLeavesTheOldOrTheNew) {
  write_old();
  const long calls = counts_of(run_).first;
  fs::remove_all(folder_ / "out");
  write_old();
  bool was_new = false;
  // From the last calls on, so that each finds what the ones before it have left.
  for (long n = calls; n > calls - 60; n -= 4) {
    SCOPED_TRACE(fmt::format("call {} of {}", n, calls));
    EXPECT_EQ(run_with(run_, fmt::format("STILLMAP_KILL_CALL={}", n)).exit_code, 137);
    was_new = is_new() || was_new;
    if (n % 8 == 0) {
      fs::remove_all(folder_ / "out");
      write_old();
    }
  }
  EXPECT_TRUE(was_new);
  ASSERT_EQ(run(run_).exit_code, 0);
  EXPECT_TRUE(is_new());
  expect_tidy();
}

// The same for a folder with many files, at every single call.
class FaultsOfDetections : public Faults {
 protected:
  FaultsOfDetections() {
    fs::create_directories(folder_ / "found/masks");
    std::string lines;
    for (int i = 0; i < kFrames; ++i) {
      const std::string stamp = fmt::format("{:.6f}", 100 + i / 30.0);
      lines += fmt::format(R"({{"stamp":"{}","objects":[{{"id":4,"class":"person","score":0.5,)"
                           R"("box":[1,2,30,40]}}]}})"
                           "\n",
                           stamp);
      cv::Mat1b mask = cv::Mat1b::zeros(240, 320);
      mask(5, 6 + i) = 4;
      write("found/masks/" + stamp + ".png", encode_mask_png(mask));
    }
    write("found/detections.jsonl", lines);
    (void)run(segment_);
    new_ = out();
    new_["masks/person7.png"] = "foreign";
    write_old();
  }

  void write_old() const {
    fs::remove_all(folder_ / "out");
    fs::create_directories(folder_ / "out/masks");
    for (const auto& [name, text] : old_) write("out/" + name, text);
  }

  const std::string segment_ = "segment wall --out out --segmenter detections:found --threads 1";
  const Content old_ = {{"detections.jsonl", "old"},
                        {"masks/100.000000.png", "old"},
                        {"masks/99.5.png", "old"},
                        {"masks/person7.png", "foreign"}};
  Content new_;
};

TEST_F(FaultsOfDetections, AreReplacedAllOrNotWhicheverCallFails) {
  ASSERT_EQ(new_.size(), 1U + kFrames + 1U);
  const long calls = counts_of(segment_).first;
  int refused = 0;
  for (long n = 1; n <= calls; ++n) {
    SCOPED_TRACE(fmt::format("call {} of {}", n, calls));
    write_old();
    const Outcome outcome = run_with(segment_, fmt::format("STILLMAP_FAIL_CALL={}", n));
    expect_clear(outcome);
    EXPECT_TRUE(out() == (outcome.exit_code == 0 ? new_ : old_)) << outcome.err;
    refused += outcome.exit_code == 0 ? 0 : 1;
  }
  EXPECT_GT(refused, 20);
  ASSERT_EQ(run(segment_).exit_code, 0);
  expect_tidy();
}

TEST_F(FaultsOfDetections, AreTheOldOrTheNewAfterAKillAtAnyCall) {
  const long calls = counts_of(segment_).first;
  write_old();
  int old = 0;
  for (long n = calls; n >= 1; --n) {
    SCOPED_TRACE(fmt::format("call {} of {}", n, calls));
    EXPECT_EQ(run_with(segment_, fmt::format("STILLMAP_KILL_CALL={}", n)).exit_code, 137);
    EXPECT_TRUE(out() == old_ || out() == new_);
    if (out() == old_) ++old;
    if (n % 2 == 0) write_old();
  }
  EXPECT_GT(old, 10);
  EXPECT_LT(old, calls);
  ASSERT_EQ(run(segment_).exit_code, 0);
  EXPECT_TRUE(out() == new_);
  expect_tidy();
}

TEST_F(Faults, ARunKilledAtARandomMomentLeavesTheOldOrTheNew) {
  write_old();
  std::mt19937 rng(20);
  for (int i = 0; i < kills(); ++i) {
    const double after_s = std::uniform_real_distribution<double>(0.01, 0.5)(rng);
    (void)run(run_, fmt::format("timeout -s KILL {:.3f}", after_s));
    if (is_new()) {
      fs::remove_all(folder_ / "out");
      write_old();
    }
  }
  ASSERT_EQ(run(run_).exit_code, 0);
  EXPECT_TRUE(is_new());
  expect_tidy();
}

TEST_F(Faults, AnInterruptedSynthLeavesAPlaceForTheNext) {
  const std::string synth = "synth office --scene empty --size 64x48 --frames 2 --threads 1";
  EXPECT_EQ(run_with(synth, "STILLMAP_KILL_CALL=6").exit_code, 137);
  EXPECT_THAT(run("run office --out out").err, HasSubstr("office: no recording that is known"));
  ASSERT_EQ(run(synth).exit_code, 0);
  EXPECT_FALSE(fs::exists(folder_ / "office/.stillmap-new"));
  EXPECT_EQ(run(synth).exit_code, 2);  // a finished one is not replaced
}

TEST_F(Faults, AnExportWritesAllOrNothingWhicheverCallFails) {
  ASSERT_EQ(run(run_).exit_code, 0);
  const std::string command = "export out --ply a.ply --pcd b.pcd --octomap c.bt";
  const long calls = counts_of(command).first;
  for (long n = 1; n <= calls; ++n) {
    SCOPED_TRACE(fmt::format("call {} of {}", n, calls));
    fs::remove(folder_ / "c.bt");
    write("a.ply", "old");
    write("b.pcd", "old");
    const Outcome outcome = run_with(command, fmt::format("STILLMAP_FAIL_CALL={}", n));
    expect_clear(outcome);
    const bool old = outcome.exit_code != 0;
    EXPECT_EQ(content("a.ply") == "old", old);
    EXPECT_EQ(content("b.pcd") == "old", old);
    EXPECT_EQ(!fs::exists(folder_ / "c.bt"), old);
  }
}

}  // namespace
}  // namespace stillmap
