// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "simulation/scene/assets.hpp"
#include "simulation/scene/world.hpp"

namespace stillmap {

/// The activity of the people in the office.
enum class Activity {
  kNone,     ///< nobody is there
  kSitting,  ///< two people at their desks, who talk and gesture
  kWalking,  ///< three people who get up, walk, cross before the camera, push a chair, carry a box
};

/// Adds the people of an activity to the office of make_office(). Their clothes vary with `seed`;
/// where `assets` has people, the seed chooses which of them come first.
void add_people(World& office,
                Activity activity,
                std::uint32_t seed,
                const Assets* assets = nullptr);

/// The state of people and things over time, for t >= 0, with continuous velocities.
class Choreography {
 public:
  /// `office` must have the people of add_people() for the same activity, and outlive the
  /// choreography.
  Choreography(const World& office, Activity activity);

  [[nodiscard]] WorldState at(double t_s) const;

 private:
  struct Cast;

  const World* office_;
  std::shared_ptr<const Cast> cast_;
};

}  // namespace stillmap
