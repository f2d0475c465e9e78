// SPDX-License-Identifier: Apache-2.0
#include "simulation/scene/choreography.hpp"

#include <algorithm>
#include <bitset>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "simulation/scene/office.hpp"
#include "simulation/scene/posture.hpp"
#include "simulation/scene/roles.hpp"
#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kLetsGo_s = 5.0;
constexpr double kPut_s = 8.2;

// An office with people, built once.
struct Staged {
  World office;
  Choreography choreography;

  explicit Staged(Activity activity)
      : office(with_people(activity)), choreography(office, activity) {}

  static World with_people(Activity activity) {
    World office = make_office(3);
    add_people(office, activity, 7);
    return office;
  }

  [[nodiscard]] std::size_t thing(const std::string& name) const {
    return static_cast<std::size_t>(&thing_named(office, name) - office.things.data());
  }
  [[nodiscard]] Isometry3d thing_at(double t_s, const std::string& name) const {
    return choreography.at(t_s).T_world_things[thing(name)];
  }
};

const Staged& walking() {
  static const Staged staged(Activity::kWalking);
  return staged;
}

const Staged& sitting() {
  static const Staged staged(Activity::kSitting);
  return staged;
}

Vector2d pelvis_of(const WorldState& state, std::size_t person) {
  return state.people[person].T_world_pelvis.translation().head<2>();
}

// A box that no person may enter.
struct Solid {
  const char* name;
  Vector3d low;
  Vector3d high;
};

const std::vector<Solid>& furniture() {
  static const std::vector<Solid> solids = {{"desk_1", {1.37, 0.17, 0.705}, {2.13, 1.73, 0.725}},
                                            {"desk_2", {1.37, -1.73, 0.705}, {2.13, -0.17, 0.725}},
                                            {"cabinet", {0.83, -2.92, 0.02}, {1.57, -2.55, 0.73}},
                                            {"side table", {2.32, 2.07, 0.56}, {2.78, 2.53, 0.58}},
                                            {"shelf", {-0.08, 2.68, 0.0}, {1.28, 3.0, 1.9}},
                                            {"waste bin", {1.87, 0.20, 0.02}, {2.03, 0.36, 0.25}},
                                            {"north wall", {-3, 3.0, 0}, {3, 4.0, 3}},
                                            {"east wall", {3.0, -3, 0}, {4.0, 3, 3}},
                                            {"south wall", {-3, -4.0, 0}, {3, -3.0, 3}}};
  return solids;
}

TEST(Choreography, NobodyIsInAnEmptyOffice) {
  const Staged staged(Activity::kNone);
  const WorldState state = staged.choreography.at(3.0);
  EXPECT_TRUE(state.people.empty());
  ASSERT_EQ(state.T_world_things.size(), staged.office.things.size());
  EXPECT_TRUE(state.T_world_things[0].matrix() == staged.office.things[0].T_world_thing.matrix());
}

TEST(Choreography, PeopleOfAnotherActivityAreAnError) {
  EXPECT_THROW(Choreography(sitting().office, Activity::kWalking), Error);
}

TEST(Choreography, PeopleAreNumberedFromOne) {
  ASSERT_EQ(walking().office.people.size(), 3U);
  EXPECT_EQ(walking().office.people[2].name, "person_3");
  EXPECT_EQ(walking().office.people[2].id, 3);
}

TEST(Choreography, WalkersKeepApart) {
  for (double t = 0.0; t < 31.0; t += 0.05) {
    const WorldState state = walking().choreography.at(t);
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        EXPECT_GT((pelvis_of(state, a) - pelvis_of(state, b)).norm(), 0.45)
            << "persons " << a + 1 << " and " << b + 1 << " at " << t;
      }
    }
  }
}

TEST(Choreography, FeetStandOnTheFloor) {
  for (double t = 0.0; t < 21.0; t += 0.11) {
    const WorldState state = walking().choreography.at(t);
    for (std::size_t i = 0; i < 3; ++i) {
      const PosedSurface surface = walking().office.people[i].body.posed(state.people[i]);
      float lowest = 1.F;
      for (const Eigen::Vector3f& p : surface.positions) lowest = std::min(lowest, p.z());
      EXPECT_NEAR(lowest, 0.F, 0.04F) << "person " << i + 1 << " at " << t;
    }
  }
}

TEST(Choreography, NobodyIsInsideFurniture) {
  for (double t = 0.0; t < 21.0; t += 0.13) {
    const WorldState state = walking().choreography.at(t);
    for (std::size_t i = 0; i < 3; ++i) {
      const PosedSurface surface = walking().office.people[i].body.posed(state.people[i]);
      for (const Solid& solid : furniture()) {
        const auto inside = [&](const Eigen::Vector3f& p) {
          const Vector3d q = p.cast<double>();
          return (q - solid.low).minCoeff() > 0 && (solid.high - q).minCoeff() > 0;
        };
        EXPECT_EQ(std::count_if(surface.positions.begin(), surface.positions.end(), inside), 0)
            << "person " << i + 1 << " at " << t << " in " << solid.name;
      }
    }
  }
}

TEST(Choreography, WalkersKeepOffTheChairs) {
  for (double t = 0.0; t < 21.0; t += 0.05) {
    const WorldState state = walking().choreography.at(t);
    const auto away = [&](std::size_t person, const std::string& chair) {
      const Isometry3d& T = state.T_world_things[walking().thing(chair)];
      return (pelvis_of(state, person) - T.translation().head<2>()).norm();
    };
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_GT(away(i, "chair_2"), 0.6) << t;
      EXPECT_GT(away(i, "chair_3"), 0.45) << "person " << i + 1 << " at " << t;
      if (i > 0) {
        EXPECT_GT(away(i, "chair_1"), 0.45) << "person " << i + 1 << " at " << t;
      }
    }
  }
}

// Velocities by central differences: bounded, and without jumps from one millisecond to the next.
TEST(Choreography, NothingJumps) {
  constexpr double kDt = 0.001;
  std::array<std::array<Vector3d, kJoints>, 3> places;
  std::array<std::array<Vector3d, kJoints>, 3> rates;
  double fastest_pelvis = 0.0;
  double fastest_joint = 0.0;
  double greatest_jump = 0.0;
  for (int step = 0; step < 21500; ++step) {
    const WorldState state = walking().choreography.at(step * kDt);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto joints = walking().office.people[i].body.T_world_joints(state.people[i]);
      for (std::size_t j = 0; j < kJoints; ++j) {
        const Vector3d place = joints[j].translation();
        const Vector3d rate = (place - places[i][j]) / kDt;
        if (step > 1) {
          const double jump = (rate - rates[i][j]).norm();
          EXPECT_LT(jump, 0.2) << "person " << i + 1 << " joint " << j << " at " << step * kDt;
          greatest_jump = std::max(greatest_jump, jump);
        }
        if (step > 0) {
          fastest_joint = std::max(fastest_joint, rate.norm());
          if (j == 0) fastest_pelvis = std::max(fastest_pelvis, rate.head<2>().norm());
        }
        places[i][j] = place;
        rates[i][j] = rate;
      }
    }
  }
  EXPECT_LT(fastest_pelvis, 1.6);
  EXPECT_LT(fastest_joint, 6.5);
  RecordProperty("greatest_jump_mm_s", static_cast<int>(1000 * greatest_jump));
}

TEST(Choreography, HandsHoldTheChairWhileItIsPushed) {
  for (double t = 0.0; t <= kLetsGo_s; t += 0.05) {
    const WorldState state = walking().choreography.at(t);
    const Isometry3d T_chair_world = state.T_world_things[walking().thing("chair_3")].inverse();
    for (const BodySide side : {BodySide::kLeft, BodySide::kRight}) {
      const Vector3d palm =
          T_chair_world * palm_place(walking().office.people[1].body, state.people[1], side);
      const Vector3d top(-0.22, std::clamp(palm.y(), -0.22, 0.22), 0.92);
      EXPECT_LT((palm - top).norm(), 0.06) << t;
    }
  }
}

TEST(Choreography, HandsHoldTheBoxWhileItIsCarried) {
  for (double t = 0.25; t <= kPut_s; t += 0.05) {
    const WorldState state = walking().choreography.at(t);
    const Isometry3d T_box_world = state.T_world_things[walking().thing("box_1")].inverse();
    for (const BodySide side : {BodySide::kLeft, BodySide::kRight}) {
      const Vector3d palm =
          T_box_world * palm_place(walking().office.people[2].body, state.people[2], side);
      const double x = side == BodySide::kLeft ? 0.2 : -0.2;
      const Vector3d on_side(x, std::clamp(palm.y(), -0.16, 0.16), std::clamp(palm.z(), 0.0, 0.3));
      EXPECT_LT((palm - on_side).norm(), 0.06) << t << " " << palm.transpose();
    }
  }
}

TEST(Choreography, WhatRestsHasTheSamePoseToTheLastBit) {
  const auto same = [](const Isometry3d& a, const Isometry3d& b) {
    return a.matrix() == b.matrix();
  };
  const Staged& staged = walking();
  for (double t = 0.0; t < 30.0; t += 0.37) {
    for (std::size_t i = 0; i < staged.office.things.size(); ++i) {
      const Thing& thing = staged.office.things[i];
      if (thing.name == "chair_3" || thing.name == "box_1") continue;
      EXPECT_TRUE(same(staged.choreography.at(t).T_world_things[i], thing.T_world_thing))
          << thing.name;
    }
    if (t <= 1.0) {
      EXPECT_TRUE(same(staged.thing_at(t, "chair_3"), staged.thing_at(0.0, "chair_3")));
    }
    if (t >= kLetsGo_s) {
      EXPECT_TRUE(same(staged.thing_at(t, "chair_3"), staged.thing_at(99.0, "chair_3"))) << t;
    }
    if (t >= kPut_s) {
      EXPECT_TRUE(same(staged.thing_at(t, "box_1"), staged.thing_at(99.0, "box_1"))) << t;
    }
  }
  EXPECT_TRUE(
      same(staged.thing_at(0.2, "box_1"), thing_named(staged.office, "box_1").T_world_thing));
  EXPECT_LT((staged.thing_at(20.0, "box_1").translation() - Vector3d(2.55, 2.3, 0.6)).norm(), 0.01);
  EXPECT_GT(staged.thing_at(20.0, "chair_3").translation().y(), 1.9);
}

TEST(Choreography, SomeoneCrossesCloseBeforeTheCameraInEachHalf) {
  const Vector2d camera(-0.4, 0.1);
  for (const double start : {0.0, 5.0, 10.0, 15.0}) {
    double nearest = 9.0;
    for (double t = start; t < start + 5.0; t += 0.05) {
      const WorldState state = walking().choreography.at(t);
      for (std::size_t i = 0; i < 3; ++i) {
        nearest = std::min(nearest, (pelvis_of(state, i) - camera).norm());
      }
    }
    EXPECT_GT(nearest, 0.9) << start;
    EXPECT_LT(nearest, 1.2) << start;
  }
}

// The share of the cells of a 64 x 48 grid over the usual image that hold vertices of people.
double share_of_people(const WorldState& state) {
  constexpr int kWidth = 64;
  constexpr int kHeight = 48;
  constexpr double kFocal = 0.82 * kWidth;
  const double pitch = 14.0 * std::numbers::pi / 180.0;
  const Vector3d forward(std::cos(pitch), 0, -std::sin(pitch));
  const Vector3d right(0, -1, 0);
  const Vector3d down = forward.cross(right);
  std::bitset<std::size_t(kWidth * kHeight)> seen;
  for (std::size_t i = 0; i < state.people.size(); ++i) {
    for (const Eigen::Vector3f& p :
         walking().office.people[i].body.posed(state.people[i]).positions) {
      const Vector3d ray = p.cast<double>() - Vector3d(-0.4, 0.1, 1.25);
      const double z = ray.dot(forward);
      if (z < 0.1) continue;
      const int x = static_cast<int>(std::floor(kFocal * ray.dot(right) / z + 0.5 * kWidth));
      const int y = static_cast<int>(std::floor(kFocal * ray.dot(down) / z + 0.5 * kHeight));
      if (x >= 0 && x < kWidth && y >= 0 && y < kHeight) seen.set(std::size_t(y * kWidth + x));
    }
  }
  return static_cast<double>(seen.count()) / double(seen.size());
}

TEST(Choreography, PeopleFillMuchOfTheViewButNeverAll) {
  double sum = 0.0;
  int count = 0;
  for (double t = 0.0; t < 20.0; t += 0.1) {
    const double share = share_of_people(walking().choreography.at(t));
    EXPECT_LT(share, 0.70) << t;  // cells at borders count whole: up to 0.1 too much
    sum += share;
    ++count;
  }
  EXPECT_GT(sum / count, 0.20);
  EXPECT_LT(sum / count, 0.45);
}

TEST(Choreography, SittersStaySeatedAndMoveTheirHands) {
  const Staged& staged = sitting();
  ASSERT_EQ(staged.office.people.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    const Body& body = staged.office.people[i].body;
    const Vector3d chair =
        thing_named(staged.office, i == 0 ? "chair_1" : "chair_2").T_world_thing.translation();
    Eigen::AlignedBox3d hand;
    for (double t = 0.0; t < 12.0; t += 0.1) {
      const WorldState state = staged.choreography.at(t);
      const Vector3d pelvis = state.people[i].T_world_pelvis.translation();
      EXPECT_LT((pelvis - chair).head<2>().norm(), 0.12);
      EXPECT_GT(pelvis.z(), 0.46);
      EXPECT_LT(pelvis.z(), 0.65);
      hand.extend(palm_place(body, state.people[i], BodySide::kRight));
    }
    EXPECT_GT(hand.diagonal().norm(), 0.25);
    EXPECT_LT(hand.diagonal().norm(), 0.9);
  }
}

}  // namespace
}  // namespace stillmap
