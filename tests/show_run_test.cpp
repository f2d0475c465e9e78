// SPDX-License-Identifier: Apache-2.0
// --view and `stillmap show` from outside, without a browser; tests/view_browser_test.mjs has one.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/cli_fixture.hpp"
#include "tests/support/plane_sequence.hpp"
#include "tooling/view/view_server.hpp"

namespace stillmap {
namespace {

class ShowRun : public Cli {
 protected:
  void SetUp() override {
    write_plane_sequence(folder_ / "wall", 20);
    if (!viewer_lacks().empty()) {
      expect_refused("run wall --out out --view", "install " + viewer_lacks());
      GTEST_SKIP() << "built without the viewer: no " << viewer_lacks();
    }
  }
};

TEST_F(ShowRun, AViewChangesNoBitAndKeepsNoProgram) {
  ASSERT_EQ(run("run wall --out plain").exit_code, 0);
  const Outcome outcome = run("run wall --out viewed --view");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.out,
              testing::MatchesRegex("view        http://127\\.0\\.0\\.1:[0-9]+/[0-9a-f]{32}/\n.*"));
  for (const char* file : {"trajectory.txt", "keyframes.txt", "map.ply", "map.stillmap"}) {
    EXPECT_EQ(content(std::string("plain/") + file), content(std::string("viewed/") + file))
        << file;
  }
}

TEST_F(ShowRun, SaysWhatAnAddressIs) {
  expect_refused("run wall --out out --view --view-address 8080",
                 "--view-address 8080: expected HOST:PORT or HOST:PORT/TOKEN");
  expect_refused("run wall --out out --view --view-address 192.0.2.1:8080",
                 "192.0.2.1:8080: cannot be listened on");
  expect_refused("run wall --out out --view-address 127.0.0.1:8080", "--view");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out" / "trajectory.txt"));
}

TEST_F(ShowRun, ShowsNothingButRuns) {
  expect_refused("show wall", "not the folder of a finished run");
  expect_refused("show nowhere", "not the folder of a finished run");
  write("x.stillmap", "no session");
  expect_refused("show x.stillmap", "x.stillmap");
  ASSERT_EQ(run("run wall --out out").exit_code, 0);
  write("out/objects.jsonl", "{}\n");
  expect_refused("show out", "out/objects.jsonl:1: expected a line of objects");
}

}  // namespace
}  // namespace stillmap
