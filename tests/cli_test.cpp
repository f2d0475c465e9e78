// SPDX-License-Identifier: Apache-2.0
// The program as its user meets it: what it prints, where, and how it exits.
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/cli_fixture.hpp"

namespace stillmap {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::MatchesRegex;
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

TEST_F(Cli, ConfigPrintsEveryKey) {
  const Outcome outcome = run("config");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.out, StartsWith("KEY "));
  for (const char* key :
       {"\nseed ", "\nloop.enabled ", "\ncloud.voxel_size_m ", "\ntracking.features "}) {
    EXPECT_THAT(outcome.out, HasSubstr(key));
  }
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

TEST_F(Cli, AFullDiskIsAnError) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  const Outcome outcome = run("config > /dev/full");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, EndsWith("standard output cannot be written\n"));
}

}  // namespace
}  // namespace stillmap
