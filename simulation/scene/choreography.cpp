// SPDX-License-Identifier: Apache-2.0
#include "simulation/scene/choreography.hpp"

#include <fmt/core.h>

#include "simulation/scene/person_shape.hpp"
#include "simulation/scene/roles.hpp"
#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

Play play_of(const World& office, Activity activity) {
  switch (activity) {
    case Activity::kSitting:
      return sitting_play(office);
    case Activity::kWalking:
      return walking_play(office);
    case Activity::kNone:
      break;
  }
  return {};
}

std::size_t people_in(Activity activity) {
  return activity == Activity::kWalking ? 3 : activity == Activity::kSitting ? 2 : 0;
}

}  // namespace

/// The roles, with their people and things.
struct Choreography::Cast {
  struct Prop {
    std::size_t thing;
    ThingMotion motion;
  };
  std::vector<Actor> actors;
  std::vector<Prop> props;
};

void add_people(World& office, Activity activity, std::uint32_t seed, const Assets* assets) {
  const auto body = [&](std::size_t i) {
    if (assets != nullptr && !assets->people.empty()) {
      return make_person(assets->people[(seed + i) % assets->people.size()], office.materials);
    }
    const std::uint64_t look_seed = 977 * std::uint64_t{seed} + 31 * i + 5;
    return make_person(random_look(look_seed), office.materials);
  };
  for (std::size_t i = 0; i < people_in(activity); ++i) {
    office.people.push_back(
        {fmt::format("person_{}", i + 1), static_cast<std::uint8_t>(i + 1), body(i)});
  }
}

Choreography::Choreography(const World& office, Activity activity) : office_(&office) {
  const Play play = play_of(office, activity);
  if (office.people.size() != play.roles.size()) {
    throw Error(
        "the office holds {} people, its choreography needs {}; use add_people() with the same "
        "activity",
        office.people.size(),
        play.roles.size());
  }
  Cast cast;
  for (std::size_t i = 0; i < play.roles.size(); ++i) {
    cast.actors.emplace_back(office.people[i].body, play.roles[i]);
  }
  for (const ThingRole& role : play.things) {
    const std::size_t thing =
        static_cast<std::size_t>(&thing_named(office, role.thing) - office.things.data());
    cast.props.push_back({thing, role.T_world_thing});
  }
  cast_ = std::make_shared<const Cast>(std::move(cast));
}

WorldState Choreography::at(double t_s) const {
  WorldState state;
  state.T_world_things.reserve(office_->things.size());
  for (const Thing& thing : office_->things) state.T_world_things.push_back(thing.T_world_thing);
  for (const Cast::Prop& prop : cast_->props) {
    state.T_world_things[prop.thing] = prop.motion(t_s);
  }
  for (const Actor& actor : cast_->actors) state.people.push_back(actor.at(t_s));
  return state;
}

}  // namespace stillmap
