// SPDX-License-Identifier: Apache-2.0
#include "simulation/synth/sequence.hpp"

#include <map>
#include <set>

#include <Eigen/LU>
#include <gtest/gtest.h>
#include <opencv2/features2d.hpp>

namespace stillmap {
namespace {

SyntheticOptions small_options(PathKind path, std::uint32_t seed = 5) {
  SyntheticOptions options;
  options.path = path;
  options.camera = synthetic_camera(320, 240);
  options.frames = 600;
  options.seed = seed;
  options.sensor = SensorOptions::clean();
  return options;
}

bool same_bytes(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && a.isContinuous() && b.isContinuous() &&
         std::equal(a.datastart, a.dataend, b.datastart);
}

// Depth between pixels: inverse depth is linear over a plane. Nothing where the sixteen pixels
// around are not on one plane.
std::optional<double> depth_at(const cv::Mat1f& depth, const Eigen::Vector2d& pixel) {
  const int x = static_cast<int>(std::floor(pixel.x()));
  const int y = static_cast<int>(std::floor(pixel.y()));
  if (x < 1 || y < 1 || x + 2 >= depth.cols || y + 2 >= depth.rows) return std::nullopt;
  const double origin = 1.0 / depth(y, x);
  const double along_x = 1.0 / depth(y, x + 1) - origin, along_y = 1.0 / depth(y + 1, x) - origin;
  for (int row = -1; row <= 2; ++row) {
    for (int column = -1; column <= 2; ++column) {
      const double plane = origin + column * along_x + row * along_y;
      if (std::abs(1.0 / depth(y + row, x + column) - plane) > 2e-5) return std::nullopt;
    }
  }
  return 1.0 / (origin + (pixel.x() - x) * along_x + (pixel.y() - y) * along_y);
}

struct Agreement {
  int agree = 0;        // within 5 mm
  int occluded = 0;     // something nearer covers the point
  int see_through = 0;  // no surface where the point should be
};

Agreement reproject(const SyntheticSequence& sequence, FrameId from, FrameId to) {
  const FramePtr a = sequence.frame(from), b = sequence.frame(to);
  const Eigen::Isometry3d T_b_a = sequence.pose(to).inverse() * sequence.pose(from);
  const CameraModel& camera = sequence.camera();
  Agreement result;
  for (int y = 0; y < camera.height_px; y += 2) {
    for (int x = 0; x < camera.width_px; x += 2) {
      const Eigen::Vector2d raw(x, y);
      const Eigen::Vector3d p_a = camera.unproject(camera.undistort(raw), a->depth.mat(y, x));
      const Eigen::Vector3d p_b = T_b_a * p_a;
      if (p_b.z() < 0.1) continue;
      const std::optional<double> z = depth_at(b->depth.mat, camera.distort(camera.project(p_b)));
      if (!z) continue;
      result.agree += std::abs(*z - p_b.z()) < 0.005 ? 1 : 0;
      result.occluded += *z < p_b.z() - 0.005 ? 1 : 0;
      result.see_through += *z > p_b.z() + 0.005 ? 1 : 0;
    }
  }
  return result;
}

TEST(SyntheticSequence, PointsLandOnTheDepthOfOtherFrames) {
  for (const PathKind path :
       {PathKind::kXyz, PathKind::kRpy, PathKind::kHalfsphere, PathKind::kLoop}) {
    const SyntheticSequence sequence(small_options(path));
    const Agreement found = reproject(sequence, FrameId(30), FrameId(60));
    EXPECT_GT(found.agree, 8000);
    EXPECT_LT(found.occluded, found.agree / 8);
    EXPECT_EQ(found.see_through, 0);
  }
}

TEST(SyntheticSequence, PointsLandOnTheDepthOfADistortedCamera) {
  SyntheticOptions options = small_options(PathKind::kXyz);
  options.camera = builtin_camera("tum_fr1");
  const SyntheticSequence sequence(options);
  const Agreement found = reproject(sequence, FrameId(0), FrameId(45));
  EXPECT_GT(found.agree, 30000);
  EXPECT_LT(found.occluded, found.agree / 8);
  EXPECT_EQ(found.see_through, 0);
}

double gray_at(const cv::Mat1b& gray, const Eigen::Vector2d& pixel) {
  const int x = static_cast<int>(pixel.x()), y = static_cast<int>(pixel.y());
  const double u = pixel.x() - x, v = pixel.y() - y;
  return (1 - v) * ((1 - u) * gray(y, x) + u * gray(y, x + 1)) +
         v * ((1 - u) * gray(y + 1, x) + u * gray(y + 1, x + 1));
}

// The shift in pixels that best explains how the brightness of frame `to` differs from that of the
// points of frame `from` (one step of Lucas and Kanade over the whole image).
Eigen::Vector2d picture_shift(const SyntheticSequence& sequence, FrameId from, FrameId to) {
  const FramePtr a = sequence.frame(from), b = sequence.frame(to);
  const Eigen::Isometry3d T_b_a = sequence.pose(to).inverse() * sequence.pose(from);
  const CameraModel& camera = sequence.camera();
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  for (int y = 0; y < camera.height_px; ++y) {
    for (int x = 0; x < camera.width_px; ++x) {
      const Eigen::Vector2d raw(x, y);
      const Eigen::Vector3d p_b =
          T_b_a * camera.unproject(camera.undistort(raw), a->depth.mat(y, x));
      if (p_b.z() < 0.1) continue;
      const Eigen::Vector2d q = camera.distort(camera.project(p_b));
      const std::optional<double> z = depth_at(b->depth.mat, q);
      if (!z || std::abs(*z - p_b.z()) > 0.005) continue;
      const Eigen::Vector2d gradient(gray_at(b->gray.mat, q + Eigen::Vector2d(0.5, 0)) -
                                         gray_at(b->gray.mat, q - Eigen::Vector2d(0.5, 0)),
                                     gray_at(b->gray.mat, q + Eigen::Vector2d(0, 0.5)) -
                                         gray_at(b->gray.mat, q - Eigen::Vector2d(0, 0.5)));
      normal += gradient * gradient.transpose();
      right += gradient * (gray_at(b->gray.mat, q) - a->gray.mat(y, x));
    }
  }
  return normal.inverse() * right;
}

TEST(SyntheticSequence, PicturesAgreeWithDepthAndPoses) {
  for (const PathKind path : {PathKind::kXyz, PathKind::kHalfsphere, PathKind::kLoop}) {
    const SyntheticSequence sequence(small_options(path));
    for (const std::uint32_t i : {0U, 90U, 200U}) {
      const Eigen::Vector2d shift = picture_shift(sequence, FrameId(i), FrameId(i + 10));
      EXPECT_LT(shift.norm(), 0.03) << static_cast<int>(path) << " at " << i;
    }
  }
  SyntheticOptions options = small_options(PathKind::kXyz);
  options.camera = builtin_camera("tum_fr1");
  const SyntheticSequence distorted(options);
  EXPECT_LT(picture_shift(distorted, FrameId(0), FrameId(10)).norm(), 0.03);
}

// Strong corners of each fortieth frame, fewest first.
std::vector<std::size_t> corners_of(const SyntheticSequence& sequence) {
  std::vector<std::size_t> counts;
  for (std::uint32_t i = 0; i < sequence.size(); i += 40) {
    std::vector<cv::KeyPoint> corners;
    cv::FAST(sequence.frame(FrameId(i))->gray.mat, corners, 20);
    counts.push_back(corners.size());
  }
  std::ranges::sort(counts);
  return counts;
}

TEST(SyntheticSequence, ShowsEnoughCorners) {
  for (const PathKind path :
       {PathKind::kXyz, PathKind::kRpy, PathKind::kHalfsphere, PathKind::kStatic}) {
    EXPECT_GE(corners_of(SyntheticSequence(small_options(path))).front(), 500U)
        << static_cast<int>(path);
  }
  // The way around the room passes bare walls.
  const std::vector<std::size_t> loop =
      corners_of(SyntheticSequence(small_options(PathKind::kLoop)));
  EXPECT_GE(loop.front(), 150U);
  EXPECT_GE(loop[loop.size() / 2], 500U);
}

TEST(SyntheticSequence, RepeatsItselfToTheByte) {
  SyntheticOptions options = small_options(PathKind::kXyz);
  options.sensor = SensorOptions{};
  const SyntheticSequence first(options), second(options);
  options.seed = 6;
  const SyntheticSequence other(options);
  const FramePtr a = first.frame(FrameId(17)), b = second.frame(FrameId(17));
  EXPECT_TRUE(same_bytes(a->color.mat, b->color.mat));
  EXPECT_TRUE(same_bytes(a->depth.mat, b->depth.mat));
  EXPECT_TRUE(same_bytes(a->gray.mat, first.frame(FrameId(17))->gray.mat));
  EXPECT_FALSE(same_bytes(a->color.mat, other.frame(FrameId(17))->color.mat));
  EXPECT_FALSE(same_bytes(a->depth.mat, other.frame(FrameId(17))->depth.mat));
}

SyntheticOptions walking_options() {
  SyntheticOptions options = small_options(PathKind::kXyz);
  options.activity = Activity::kWalking;
  return options;
}

// Corners of an object's surface that nothing hides land on its rendered depth.
TEST(SyntheticSequence, SurfacesOfPeopleAndThingsLandOnTheirDepth) {
  const SyntheticSequence sequence(walking_options());
  const World& world = sequence.world();
  int on_surface = 0, hidden = 0, see_through = 0;
  for (const std::uint32_t k : {0U, 60U, 110U, 150U, 240U}) {
    const RenderedImage truth = sequence.render(FrameId(k)).truth;
    const WorldState state = sequence.state(FrameId(k));
    const Eigen::Isometry3d T_camera_world = sequence.pose(FrameId(k)).inverse();
    const auto check = [&](const Eigen::Vector3d& p_world) {
      const Eigen::Vector3d p = T_camera_world * p_world;
      if (p.z() < 0.1) return;
      const Eigen::Vector2d pixel = sequence.camera().project(p);
      const cv::Point at(static_cast<int>(std::lround(pixel.x())),
                         static_cast<int>(std::lround(pixel.y())));
      if (!cv::Rect(1, 1, 318, 238).contains(at)) return;
      // At least one of the surrounding pixels must be no farther than the corner.
      double nearest = 1e9, farthest = 0;
      for (int v = at.y - 1; v <= at.y + 1; ++v) {
        for (int u = at.x - 1; u <= at.x + 1; ++u) {
          nearest = std::min<double>(nearest, truth.depth.mat(v, u));
          farthest = std::max<double>(farthest, truth.depth.mat(v, u));
        }
      }
      if (nearest > p.z() + 0.01) ++see_through;
      if (farthest < p.z() - 0.01) ++hidden;
      if (nearest < p.z() + 0.01 && farthest > p.z() - 0.01) ++on_surface;
    };
    for (std::size_t i = 0; i < world.people.size(); ++i) {
      for (const Eigen::Vector3f& p : world.people[i].body.posed(state.people[i]).positions) {
        check(p.cast<double>());
      }
    }
    for (std::size_t i = 0; i < world.things.size(); ++i) {
      for (const Eigen::Vector3f& p : world.things[i].mesh.positions) {
        check(state.T_world_things[i] * p.cast<double>());
      }
    }
  }
  EXPECT_GT(on_surface, 50000);
  EXPECT_LT(hidden, 5 * on_surface);
  EXPECT_LE(see_through, on_surface / 400);  // wires and leaves thinner than a pixel
}

// Where the mask has a person or a thing, the depth is within the extent of that body.
TEST(SyntheticSequence, MasksAgreeWithDepth) {
  const SyntheticSequence sequence(walking_options());
  const World& world = sequence.world();
  std::set<int> seen;
  for (const std::uint32_t k : {0U, 60U, 110U, 150U, 240U}) {
    const RenderedImage truth = sequence.render(FrameId(k)).truth;
    const WorldState state = sequence.state(FrameId(k));
    std::map<int, Eigen::AlignedBox3d> extents;
    for (std::size_t i = 0; i < world.people.size(); ++i) {
      for (const Eigen::Vector3f& p : world.people[i].body.posed(state.people[i]).positions) {
        extents[world.people[i].id].extend(p.cast<double>());
      }
    }
    for (std::size_t i = 0; i < world.things.size(); ++i) {
      if (world.things[i].id == 0) continue;
      for (const Eigen::Vector3f& p : world.things[i].mesh.positions) {
        extents[world.things[i].id].extend(state.T_world_things[i] * p.cast<double>());
      }
    }
    for (int y = 0; y < truth.ids.rows; ++y) {
      for (int x = 0; x < truth.ids.cols; ++x) {
        const int id = truth.ids(y, x);
        if (id == 0) continue;
        ASSERT_TRUE(extents.contains(id));
        seen.insert(id);
        const Eigen::Vector3d p_world =
            sequence.pose(FrameId(k)) *
            sequence.camera().unproject(Eigen::Vector2d(x, y), truth.depth.mat(y, x));
        ASSERT_LT(extents[id].exteriorDistance(p_world), 0.005) << id << " in frame " << k;
      }
    }
  }
  EXPECT_GE(seen.size(), 6U);  // three people, two chairs at least, the carton
}

TEST(SyntheticSequence, KnowsWhatMoves) {
  SyntheticOptions options = walking_options();
  options.frames = 300;
  const SyntheticSequence walking(options);
  EXPECT_EQ(walking.moved_ids(), (std::vector<int>{1, 2, 3, 12, 13}));
  options.activity = Activity::kSitting;
  EXPECT_EQ(SyntheticSequence(options).moved_ids(), (std::vector<int>{1, 2}));
  options.activity = Activity::kNone;
  EXPECT_TRUE(SyntheticSequence(options).moved_ids().empty());
  // The chair is pushed at about a metre a second, and stands at the end.
  const auto speed_of_chair = [&](std::uint32_t k) {
    for (const ObjectSpeed& object : walking.speeds(FrameId(k))) {
      if (object.id == 12) return object.speed_mps;
    }
    return -1.0;
  };
  EXPECT_GT(speed_of_chair(90), 0.5);
  EXPECT_EQ(speed_of_chair(200), 0.0);
}

TEST(SyntheticSequence, HasStampsOfItsRate) {
  const SyntheticSequence sequence(small_options(PathKind::kStatic));
  EXPECT_EQ(sequence.stamp(FrameId(0)).text, "1000.000000");
  EXPECT_EQ(sequence.stamp(FrameId(31)).text, "1001.033333");
  EXPECT_EQ(sequence.stamp(FrameId(31)).seconds, 1001.033333);
  const Trajectory truth = sequence.ground_truth();
  ASSERT_EQ(truth.size(), sequence.size());
  EXPECT_EQ(truth[31].stamp.text, "1001.033333");
  const Eigen::Isometry3d expected = T_world_camera(PathKind::kStatic, 31.0 / 30.0);
  EXPECT_TRUE(truth[31].T_world_camera.isApprox(expected, 1e-12));
  EXPECT_EQ(sequence.frame(FrameId(31))->depth_stamp_s, 1001.033333);
}

TEST(SyntheticCamera, KeepsTheFieldOfViewOfTheOriginal) {
  const CameraModel original = builtin_camera("tum_fr3");
  const CameraModel same = synthetic_camera(640, 480);
  EXPECT_DOUBLE_EQ(same.fx, original.fx);
  EXPECT_DOUBLE_EQ(same.cx, original.cx);
  EXPECT_DOUBLE_EQ(same.cy, original.cy);
  const CameraModel half = synthetic_camera(320, 240);
  EXPECT_DOUBLE_EQ(half.fy, 0.5 * original.fy);
  // The outer border of the image, half a pixel beyond the first centre, stays where it was.
  EXPECT_NEAR((-0.5 - half.cx) / half.fx, (-0.5 - original.cx) / original.fx, 1e-12);
  EXPECT_NEAR((-0.5 - half.cy) / half.fy, (-0.5 - original.cy) / original.fy, 1e-12);
}

// Frames at 40 a second, whose times are those of some rows of frames at 30 a second.
SyntheticOptions fast_options() {
  SyntheticOptions options = small_options(PathKind::kXyz);
  options.frames_per_second = 40;
  return options;
}

double share_of_equal_depth(const cv::Mat1f& a, const cv::Mat1f& b) {
  int equal = 0;
  for (int x = 0; x < a.cols; ++x) equal += std::abs(a(0, x) - b(0, x)) < 1e-4F ? 1 : 0;
  return static_cast<double>(equal) / a.cols;
}

TEST(SyntheticSequence, RowsOfARollingShutterAreThoseOfTheirTimes) {
  SyntheticOptions options = small_options(PathKind::kXyz);
  options.delays = {.readout_s = 0.1, .depth_readout_s = 0.1};
  const SyntheticSequence rolling(options), fast(fast_options());
  const FramePtr seen = rolling.frame(FrameId(30));
  // The first row is read at 0.95 s, the middle one at 1 s, that at three quarters at 1.025 s.
  for (const std::pair<int, int>& row_and_frame : {std::pair{0, 38}, {120, 40}, {180, 41}}) {
    const int row = row_and_frame.first, frame = row_and_frame.second;
    const FramePtr then = fast.frame(FrameId(static_cast<std::uint32_t>(frame)));
    const FramePtr other = fast.frame(FrameId(static_cast<std::uint32_t>(frame + 2)));
    EXPECT_GT(share_of_equal_depth(seen->depth.mat.row(row), then->depth.mat.row(row)), 0.98);
    EXPECT_LT(share_of_equal_depth(seen->depth.mat.row(row), other->depth.mat.row(row)), 0.5);
    const auto difference = [&](const FramePtr& of) {
      return cv::norm(seen->color.mat.row(row), of->color.mat.row(row), cv::NORM_L1);
    };
    EXPECT_LT(difference(then), 0.25 * difference(other));
  }
}

TEST(SyntheticSequence, DepthIsTakenLaterAndItsStampMayTell) {
  SyntheticOptions options = small_options(PathKind::kXyz);
  options.delays.depth_delay_s = 0.05;
  const SyntheticSequence late(options), fast(fast_options()),
      punctual(small_options(PathKind::kXyz));
  const SyntheticFrame seen = late.render(FrameId(30));
  EXPECT_TRUE(same_bytes(seen.frame->depth.mat, fast.frame(FrameId(42))->depth.mat));
  const SyntheticFrame plain = punctual.render(FrameId(30));
  EXPECT_TRUE(same_bytes(seen.frame->color.mat, plain.frame->color.mat));
  EXPECT_TRUE(same_bytes(seen.truth.depth.mat, plain.truth.depth.mat));
  EXPECT_NEAR(seen.frame->depth_stamp_s, seen.frame->stamp.seconds + 0.05, 1e-6);
  options.delays.depth_stamps_tell = false;
  const SyntheticSequence hidden(options);
  EXPECT_EQ(hidden.depth_stamp(FrameId(30)).text, hidden.stamp(FrameId(30)).text);
}

}  // namespace
}  // namespace stillmap
