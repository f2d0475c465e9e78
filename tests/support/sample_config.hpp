// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "stillmap/core/fields.hpp"

namespace stillmap::test {

struct LoopConfig {
  bool enabled = true;
  double min_score = 0.25;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("enabled", self.enabled, FieldInfo{"close loops"});
    visit("min_score", self.min_score, FieldInfo{"similarity that suffices", "", 0.0, 1.0});
  }
};

struct TrackingConfig {
  int features = 1000;
  double max_depth_m = 6.0;
  LoopConfig loop;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("features", self.features, common_setting(FieldInfo{"corners a frame", "", 100, 10000}));
    visit("max_depth_m", self.max_depth_m, FieldInfo{"farthest depth used", "m", 0.1, 20.0});
    visit.group("loop", self.loop);
  }
};

/// A configuration with every kind of value, for the tests of this module.
struct Config {
  std::uint32_t seed = 1;
  int offset = -3;
  double gain = 0.1;
  std::string dynamics = "full";
  std::string note;
  TrackingConfig tracking;
  double last = 2.5;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("seed", self.seed, common_setting(FieldInfo{"start of all random numbers"}));
    visit("offset", self.offset, FieldInfo{"any whole number"});
    visit("gain", self.gain, FieldInfo{"any number", "1/s"});
    visit("dynamics", self.dynamics, FieldInfo{.meaning = "method", .choices = {"off", "full"}});
    visit("note", self.note, FieldInfo{"free text"});
    visit.group("tracking", self.tracking);
    visit("last", self.last, FieldInfo{.meaning = "after a group", .unit = "m", .min = 0.0});
  }
};

}  // namespace stillmap::test
