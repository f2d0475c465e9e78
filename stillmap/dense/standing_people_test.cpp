// SPDX-License-Identifier: Apache-2.0
#include "stillmap/dense/standing_people.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace stillmap {
namespace {

constexpr double kStep_s = 1.0 / 30;
constexpr double kPerson_m = 2.0, kWall_m = 4.0;  // from the camera

const CameraModel& camera() {
  static const CameraModel model = builtin_camera("tum_fr3");
  return model;
}

std::vector<Eigen::Vector3d> standing_at(double x_m) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 8; ++i) {
    for (int j = 0; j < 16; ++j) points.emplace_back(x_m + 0.05 * i, 0.05 * j - 0.4, kPerson_m);
  }
  return points;
}

/// A view of the wall, and of a person before it whom no mask covers.
StaticView view_of_wall(bool with_person) {
  PointCloud cloud;
  for (double v = 2; v < 480; v += 4) {
    for (double u = 2; u < 640; u += 4) {
      const Eigen::Vector3d at_person = camera().unproject({u, v}, kPerson_m);
      const bool person =
          with_person && at_person.x() >= 0 && at_person.x() < 0.4 && std::abs(at_person.y()) < 0.4;
      cloud.positions.push_back(
          (person ? at_person : camera().unproject({u, v}, kWall_m)).cast<float>());
    }
  }
  cloud.colors.resize(cloud.positions.size());
  return {compact(cloud), {}};
}

/// A person who comes from `from_m` to x = 0, stands there for `stands` frames, and is not seen
/// after that.
StandingPeople after_walk(double from_m, int stands) {
  StandingPeople people;
  for (int k = -30; k < stands; ++k) {
    people.remember((30 + k) * kStep_s,
                    {{TrackId(1), standing_at(k < 0 ? from_m * -k / 30.0 : 0)}});
  }
  return people;
}

std::size_t unseen(StandingPeople& people, bool with_person, double stamp_s) {
  return people
      .unseen_in(view_of_wall(with_person), camera(), Eigen::Isometry3d::Identity(), stamp_s)
      .size();
}

TEST(StandingPeople, StayUntilAViewSeesThroughTheirPlace) {
  StandingPeople people = after_walk(-1, 40);
  EXPECT_EQ(unseen(people, true, 5), 128U);
  EXPECT_EQ(unseen(people, true, 60), 128U) << "a minute later";
  EXPECT_EQ(unseen(people, false, 61), 0U) << "the wall is seen";
  EXPECT_EQ(unseen(people, true, 62), 0U) << "something else stands there";
}

TEST(StandingPeople, AreNotThoseWhoAreSeenOrWalkOnOrNeverWalked) {
  StandingPeople seen = after_walk(-1, 40);
  seen.remember(5, {{TrackId(1), {}}});  // hardly, by the network
  EXPECT_EQ(unseen(seen, true, 5), 0U);
  StandingPeople walking = after_walk(-1, 10), thing = after_walk(0, 40);
  EXPECT_EQ(unseen(walking, true, 5), 0U);
  EXPECT_EQ(unseen(thing, true, 5), 0U);
}

TEST(StandingPeople, StayWhileTheCameraLooksElsewhere) {
  StandingPeople people = after_walk(-1, 40);
  const Eigen::Isometry3d away(Eigen::AngleAxisd(1.5, Eigen::Vector3d::UnitY()));
  EXPECT_TRUE(people.unseen_in(view_of_wall(false), camera(), away, 5).empty());
  EXPECT_EQ(unseen(people, true, 6), 128U);
}

}  // namespace
}  // namespace stillmap
