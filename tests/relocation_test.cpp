// SPDX-License-Identifier: Apache-2.0
// A camera among people is covered for a second and goes on elsewhere: seeded trials, small ones of
// those in docs/place-recognition.md.
#include <algorithm>
#include <map>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "simulation/synth/detection_faults.hpp"
#include "simulation/synth/sequence.hpp"
#include "stillmap/geometry/se3.hpp"
#include "tests/relocation_trial.hpp"

namespace stillmap {
namespace {

constexpr std::uint32_t kFirst = 40;  // people come in
constexpr std::uint32_t kKnown = 100;
constexpr std::uint32_t kEnd = 180;
constexpr std::uint32_t kShown = 8;
constexpr int kDark = 30;

SyntheticSequence office(PathKind path, std::uint32_t seed) {
  SyntheticOptions options;
  options.path = path;
  options.seed = seed;
  options.camera = synthetic_camera(320, 240);
  options.activity = path == PathKind::kLoop ? Activity::kNone : Activity::kWalking;
  return SyntheticSequence(options);
}

const SyntheticSequence& known_office() {
  static const SyntheticSequence kOffice = office(PathKind::kXyz, 0);
  return kOffice;
}

// With what a network without fault says.
TrialView make_view(const SyntheticSequence& sequence, std::uint32_t k) {
  const FrameId id(k);
  const SyntheticFrame rendered = sequence.render(id);
  FrameTruth truth{id, sequence.stamp(id), ObjectMask(rendered.truth.ids), {}};
  for (const TruthFrameObject& seen : frame_objects(truth.mask, sequence.speeds(id))) {
    const char* name = seen.id < 10 ? "person" : seen.id < 13 ? "chair" : "box";
    truth.objects.push_back({seen.id, name, seen.box, seen.pixels, 1.0});
  }
  return {rendered.frame, perfect_detections(truth), sequence.pose(id)};
}

// Rendered once, when first asked for.
const TrialView& known_view(std::uint32_t k) {
  static std::map<std::uint32_t, TrialView> rendered;
  const auto at = rendered.find(k);
  return at != rendered.end() ? at->second
                              : rendered.emplace(k, make_view(known_office(), k)).first->second;
}

RelocationTrial trial_in_the_dark() {
  RelocationTrial trial({}, synthetic_camera(320, 240));
  for (std::uint32_t k = kFirst; k < kKnown; ++k) trial.show(known_view(k));
  trial.cover(kDark);
  return trial;
}

TrialOutcome go_on_at(std::uint32_t jump_to) {
  RelocationTrial trial = trial_in_the_dark();
  for (std::uint32_t k = jump_to; k < jump_to + kShown; ++k) trial.show(known_view(k));
  return judge_trial(trial.finish());
}

// Whether it was found again within five frames. Late is allowed, wrong or invented is not.
bool is_found_soon(std::uint32_t jump_to) {
  const TrialOutcome outcome = go_on_at(jump_to);
  EXPECT_EQ(outcome.invented, 0) << jump_to;
  EXPECT_TRUE(outcome.found_at == 0 || outcome.right())
      << jump_to << ": " << outcome.error_m << " m, " << outcome.error_deg << " degrees";
  EXPECT_LT(outcome.largest_error_m, 0.06) << jump_to;
  return outcome.found_at >= 1 && outcome.found_at <= 5;
}

// Whether a frame shows what one of the known part does, from nearby but not from there.
bool is_near_the_known_part(std::uint32_t k) {
  double nearest_m = 1e9;
  bool near = false;
  for (std::uint32_t j = kFirst; j < kKnown; ++j) {
    const Eigen::Isometry3d T =
        known_office().pose(FrameId(k)).inverse() * known_office().pose(FrameId(j));
    const double apart_m = T.translation().norm();
    const double apart_deg = rotation_angle(T.linear()) * 180.0 / std::numbers::pi;
    near = near || (apart_m < 0.3 && apart_deg < 15.0);
    nearest_m = std::min(nearest_m, apart_m);
  }
  return near && nearest_m > 0.03;
}

TEST(RelocationTrials, FindAPlaceThatWasThere) {
  std::mt19937 rng(1);
  for (int i = 0; i < 3; ++i) {
    const std::uint32_t jump_to = kFirst + static_cast<std::uint32_t>(rng() % 40);
    EXPECT_TRUE(is_found_soon(jump_to)) << jump_to;
  }
}

TEST(RelocationTrials, FindAPlaceFromNearby) {
  std::vector<std::uint32_t> frames;
  for (std::uint32_t k = kKnown; k + kShown < kEnd; ++k) {
    if (is_near_the_known_part(k)) frames.push_back(k);
  }
  ASSERT_GT(frames.size(), 10U);
  std::size_t found = 0, trials = 0;
  for (std::size_t i = 0; i < frames.size(); i += 3) {
    found += is_found_soon(frames[i]) ? 1U : 0U;
    ++trials;
  }
  EXPECT_GE(2 * found, trials);  // in some, people hide most of what is known
}

TEST(RelocationTrials, StayLostInAnUnknownPlace) {
  const SyntheticSequence elsewhere = office(PathKind::kLoop, 5);
  RelocationTrial trial = trial_in_the_dark();
  for (std::uint32_t k = 100; k < 250; k += 15) trial.show(make_view(elsewhere, k));
  const TrialOutcome outcome = judge_trial(trial.finish());
  EXPECT_EQ(outcome.shown, 10);
  EXPECT_EQ(outcome.tracked, 0);
  EXPECT_EQ(outcome.invented, 0);
}

}  // namespace
}  // namespace stillmap
