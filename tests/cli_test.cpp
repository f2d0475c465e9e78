// SPDX-License-Identifier: Apache-2.0
// The program as its user meets it: what it prints, where, and how it exits.
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/cli_fixture.hpp"

namespace stillmap {
namespace {

using testing::Contains;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::MatchesRegex;
using testing::Not;
using testing::StartsWith;

TEST_F(Cli, HelpShowsCommandsAndExamples) {
  const Outcome outcome = run("--help");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.err, IsEmpty());
  EXPECT_THAT(outcome.out, HasSubstr("Usage: stillmap [OPTIONS] SUBCOMMAND"));
  EXPECT_THAT(outcome.out, HasSubstr("Examples:\n"));
  EXPECT_THAT(outcome.out, HasSubstr("\n  config "));
  EXPECT_THAT(run("config --help").out, HasSubstr("Usage: stillmap config [OPTIONS] [FILE]"));
}

TEST_F(Cli, VersionNamesTheLibraries) {
  const Outcome outcome = run("--version");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.out, StartsWith("stillmap " STILLMAP_VERSION));
  for (const char* library : {"OpenCV 4.", "Eigen 3.", "fmt ", "yaml-cpp 0.", "libpng 1."}) {
    EXPECT_THAT(outcome.out, HasSubstr(library));
  }
}

TEST_F(Cli, BadUsageIsOneLineThatPointsToTheHelp) {
  const Outcome no_command = run("");
  EXPECT_EQ(no_command.exit_code, 2);
  EXPECT_THAT(no_command.out, IsEmpty());
  EXPECT_THAT(no_command.err, MatchesRegex("stillmap: [^\n]* \\(see stillmap --help\\)\n"));

  const Outcome misspelt = run("confg");
  EXPECT_EQ(misspelt.exit_code, 2);
  EXPECT_EQ(misspelt.err,
            "stillmap: unknown command 'confg': did you mean 'config'? (see stillmap --help)\n");

  const Outcome surplus = run("config a.yaml b.yaml");
  EXPECT_EQ(surplus.exit_code, 2);
  EXPECT_THAT(surplus.err,
              MatchesRegex("stillmap: [^\n]*b.yaml \\(see stillmap config --help\\)\n"));

  const Outcome option = run("config --wrong");
  EXPECT_EQ(option.exit_code, 2);
  EXPECT_THAT(option.err,
              MatchesRegex("stillmap: [^\n]*--wrong \\(see stillmap config --help\\)\n"));
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

// The first words of the lines that are not indented, without the table's head.
std::vector<std::string> keys_of(const std::string& table) {
  std::vector<std::string> keys;
  for (const std::string& line : lines_of(table)) {
    if (!line.starts_with(' ')) keys.push_back(line.substr(0, line.find(' ')));
  }
  if (!keys.empty()) keys.erase(keys.begin());
  return keys;
}

TEST_F(Cli, ConfigPrintsTheSettingsThatPeopleChange) {
  const Outcome outcome = run("config");
  EXPECT_EQ(outcome.exit_code, 0);
  std::vector<std::string> common = keys_of(outcome.out);
  ASSERT_GT(common.size(), 10U);
  EXPECT_LT(common.size(), 30U);
  common.pop_back();  // the line that says how many more there are
  for (const char* key : {"seed", "loop.enabled", "cloud.voxel_size_m", "dynamics.mode"}) {
    EXPECT_THAT(common, Contains(key));
  }
  const std::vector<std::string> all = keys_of(run("config --all").out);
  EXPECT_GT(all.size(), 100U);
  for (const std::string& key : common) EXPECT_THAT(all, Contains(key));
  EXPECT_THAT(outcome.out,
              EndsWith(fmt::format("\n{} more settings: stillmap config --all\n",
                                   all.size() - common.size())));
}

TEST_F(Cli, ConfigPrintsNarrowLines) {
  for (const std::string& line : lines_of(run("config --all").out)) {
    EXPECT_LE(line.size(), 100U) << line;
  }
}

TEST_F(Cli, TheSettingsPageIsCurrent) {
  std::ostringstream page;
  page << std::ifstream(STILLMAP_SOURCE_DIR "/docs/settings.md").rdbuf();
  EXPECT_THAT(page.str(), HasSubstr("\n```\n" + run("config --all").out + "```\n"))
      << "write the page again: tools/settings_page";
}

TEST_F(Cli, ConfigChecksAFile) {
  write("good.yaml", "seed: 5\n");
  const Outcome good = run("config good.yaml");
  EXPECT_EQ(good.exit_code, 0);
  EXPECT_EQ(good.out, "good.yaml: a correct configuration\n");

  write("bad.yaml", "# one\nsead: 5\n");
  const Outcome bad = run("config bad.yaml");
  EXPECT_EQ(bad.exit_code, 2);
  EXPECT_EQ(bad.err, "stillmap: bad.yaml:2: unknown key 'sead': did you mean 'seed'?\n");

  const Outcome missing = run("config missing.yaml");
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_THAT(missing.err, StartsWith("stillmap: missing.yaml: cannot be opened: "));
}

TEST_F(Cli, SynthRendersTheRoomWithoutPeople) {
  const std::string scene = " --scene sitting_static --frames 3 --size 64x48 --assets none";
  ASSERT_EQ(run("synth office" + scene).exit_code, 0);
  ASSERT_EQ(run("synth room --without people" + scene).exit_code, 0);
  EXPECT_EQ(content("room/groundtruth.txt"), content("office/groundtruth.txt"));
  EXPECT_THAT(content("room/truth/dynamic_map.ply"), HasSubstr("element vertex 0\n"));
  EXPECT_THAT(content("office/truth/dynamic_map.ply"), Not(HasSubstr("element vertex 0\n")));
}

TEST_F(Cli, AFullDiskIsAnError) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  const Outcome outcome = run("config > /dev/full");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, EndsWith("standard output cannot be written\n"));
}

}  // namespace
}  // namespace stillmap
