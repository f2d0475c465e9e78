// SPDX-License-Identifier: Apache-2.0
// Visits of one rendered office, merged in any order.
#include "stillmap/session/merge_tree.hpp"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stillmap/config/config_io.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "stillmap/session/session_io.hpp"
#include "stillmap/session/session_map.hpp"
#include "stillmap/session/system_config.hpp"
#include "stillmap/system/system.hpp"
#include "tests/support/files.hpp"
#include "tests/support/rendered_room.hpp"
#include "tooling/eval/ate.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;

class VisitsOfAnOffice : public testing::Test {
 protected:
  // Of every second frame from `begin` on, saved in a file of that name.
  fs::path visit(std::uint32_t begin, std::uint32_t end) const {
    SystemConfig config;
    config.dynamics.mode = "off";
    System system(config, office_.camera(), {.threads = 2});
    for (std::uint32_t k = begin; k < end; k += 2) (void)system.process(office_.frame(k));
    (void)system.finish();
    Session session = system.take_session();
    session.config_yaml = dump_yaml(list_fields(config));
    fs::path file = folder_.path() / std::to_string(begin);
    write_session(file, session);
    return file;
  }

  [[nodiscard]] std::vector<MergedPart> merged(const std::vector<fs::path>& files,
                                               const std::string& scratch) const {
    fs::create_directory(folder_.path() / scratch);
    return merge_as_tree(files, folder_.path() / scratch);
  }

  // All frames of all visits; the shared ones once.
  [[nodiscard]] double error_m(const Session& session) const {
    Trajectory all = trajectory_in(session, main_submap(session));
    std::ranges::stable_sort(all, {}, [](const StampedPose& pose) { return pose.stamp.seconds; });
    const auto same = [](const StampedPose& a, const StampedPose& b) {
      return a.stamp.seconds == b.stamp.seconds;
    };
    all.erase(std::unique(all.begin(), all.end(), same), all.end());
    const std::optional<AteResult> ate =
        absolute_trajectory_error(office_.sequence().ground_truth(), all);
    return ate ? ate->translation_m.rmse : std::numeric_limits<double>::infinity();
  }

  const RenderedRoom office_{400, PathKind::kLoop};
  const TemporaryFolder folder_;
};

TEST_F(VisitsOfAnOffice, MakeOneMapInAnyOrderAndWhatIsElsewhereStaysApart) {
  // The first and the third have only the second in common; nobody else was at the last one's
  // place.
  const fs::path a = visit(0, 80), b = visit(50, 130), c = visit(100, 180), d = visit(330, 390);
  const std::vector<MergedPart> parts = merged({a, b, c, d}, "in_time");
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_THAT(parts[0].sessions, ElementsAre(a.string(), b.string(), c.string()));
  EXPECT_GE(parts[0].loops, 2U);
  EXPECT_THAT(parts[1].sessions, ElementsAre(d.string()));
  EXPECT_EQ(parts[1].file, d);

  const Session room = read_session(parts[0].file);
  room.map.check_consistency();
  EXPECT_EQ(room.map.submaps().size(), 1U);
  EXPECT_EQ(room.map.keyframes().size(), parts[0].keyframes);
  EXPECT_EQ(room.frames.size(), 3 * 40U);
  EXPECT_LT(error_m(room), 0.04);
  // The coordinates are those of the earliest.
  const Session first = read_session(a);
  const KeyframeId origin = first.map.keyframes().begin()->first;
  EXPECT_TRUE(room.map.T_world_keyframe(origin).isApprox(first.map.T_world_keyframe(origin)));

  const std::vector<MergedPart> shuffled = merged({d, c, a, b}, "shuffled");
  ASSERT_EQ(shuffled.size(), 2U);
  EXPECT_EQ(shuffled[0].sessions, parts[0].sessions);
  constexpr std::size_t kMuch = 1 << 30;
  EXPECT_EQ(read_file(shuffled[0].file, kMuch), read_file(parts[0].file, kMuch));
  // Of the maps on the way nothing is left.
  for (const char* scratch : {"in_time", "shuffled"}) {
    const fs::directory_iterator files(folder_.path() / scratch);
    EXPECT_EQ(std::distance(begin(files), end(files)), 1);
  }
}

}  // namespace
}  // namespace stillmap
