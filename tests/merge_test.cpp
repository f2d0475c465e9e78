// SPDX-License-Identifier: Apache-2.0
// `stillmap merge` from outside, of sessions that have no place in common.
// stillmap/system/merge_tree_test.cpp has those that have.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "stillmap/config/config_io.hpp"
#include "stillmap/session/session_io.hpp"
#include "stillmap/session/system_config.hpp"
#include "tests/support/cli_fixture.hpp"

namespace stillmap {
namespace {

class Merge : public Cli {
 protected:
  Merge() {
    save("late", 9);
    save("early", 3);
  }

  // A session of one frame, in which nothing was seen.
  void save(const std::string& name, double stamp_s, const std::string& camera = "tum_fr1") const {
    Session session;
    session.map = Map({1});
    SystemConfig config;
    session.config_yaml = dump_yaml(list_fields(config));
    session.camera = builtin_camera(camera);
    Keyframe keyframe;
    keyframe.features = std::make_shared<const Features>();
    keyframe.stamp = {stamp_s, std::to_string(stamp_s)};
    const Stamp stamp = keyframe.stamp;
    const KeyframeId id = session.map.add_keyframe(std::move(keyframe));
    session.frames.push_back({stamp, id, Eigen::Isometry3d::Identity()});
    write_session(folder_ / name, session);
  }

  [[nodiscard]] bool has(const std::string& name) const {
    return std::filesystem::exists(folder_ / name);
  }
};

TEST_F(Merge, WritesNoLargestMapOfSessionsThatAreApart) {
  expect_refused("merge late early --out room", "no place of one is recognised in the other");
  EXPECT_FALSE(has("room"));
}

TEST_F(Merge, PartsAreAllMapsThatThereAre) {
  const Outcome outcome = run("merge late early --parts room");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "apart       early (1 key frame)\napart       late (1 key frame)\n");
  EXPECT_EQ(content("room/1.stillmap"), content("early"));
  EXPECT_EQ(content("room/2.stillmap"), content("late"));
  const nlohmann::json parts = nlohmann::json::parse(content("room/parts.json"));
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts[0],
            nlohmann::json({{"file", "1.stillmap"},
                            {"keyframes", 1},
                            {"loops", 0},
                            {"sessions", nlohmann::json::array({"early"})}}));
  // Files of others stay, maps of before do not.
  save("third", 5);
  write("room/notes.txt", "mine");
  EXPECT_EQ(run("merge third late early --parts room").exit_code, 0);
  EXPECT_TRUE(has("room/3.stillmap"));
  EXPECT_EQ(run("merge late early --parts room").exit_code, 0);
  EXPECT_FALSE(has("room/3.stillmap"));
  EXPECT_EQ(content("room/notes.txt"), "mine");
}

TEST_F(Merge, RefusesWhatCannotBe) {
  expect_refused("merge late early", "--out FILE or --parts FOLDER");
  expect_refused("merge late early --out a --parts b", "--out FILE or --parts FOLDER");
  expect_refused("merge late --out a", "SESSIONS");
  expect_refused("merge late early --out early", "would be overwritten");
  expect_refused("merge late early --parts .", "would be overwritten");
  expect_refused("merge late missing --out a", "missing");
  save("other", 5, "tum_fr2");
  expect_refused("merge late other --out a", "late is of camera 'tum_fr1'");
}

}  // namespace
}  // namespace stillmap
