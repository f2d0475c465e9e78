// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>

namespace stillmap {

/// A strong integer id: ids with different tags do not convert into each other. A default
/// constructed id is invalid.
template <class Tag>
struct Id {
  /// The value of an invalid id.
  static constexpr std::uint32_t kInvalidValue = std::numeric_limits<std::uint32_t>::max();

  /// The id as a number.
  std::uint32_t value = kInvalidValue;

  constexpr Id() = default;
  /// The id with the number `v`.
  constexpr explicit Id(std::uint32_t v) : value(v) {}

  /// Whether the id names anything.
  [[nodiscard]] constexpr bool valid() const { return value != kInvalidValue; }
  /// The number as an index into an array.
  [[nodiscard]] constexpr std::size_t index() const { return value; }
  /// Ids are ordered by their numbers; an invalid id comes last.
  constexpr auto operator<=>(const Id&) const = default;
};

/// Position of a frame in its sequence, counted from 0 over the whole sequence.
using FrameId = Id<struct FrameTag>;
/// Number of a key frame in its map, in the order in which they were made.
using KeyframeId = Id<struct KeyframeTag>;
/// Number of a landmark in its map, in the order in which they were made.
using LandmarkId = Id<struct LandmarkTag>;
/// The coordinate frame shared by key frames that tracking, loops or relocalisation tie together.
/// Tracking that stays lost begins another submap.
using SubmapId = Id<struct SubmapTag>;

}  // namespace stillmap

/// Ids may be keys of unordered containers.
template <class Tag>
struct std::hash<stillmap::Id<Tag>> {
  /// The number itself.
  std::size_t operator()(stillmap::Id<Tag> id) const noexcept { return id.value; }
};
