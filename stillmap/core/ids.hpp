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
  static constexpr std::uint32_t kInvalidValue = std::numeric_limits<std::uint32_t>::max();

  std::uint32_t value = kInvalidValue;

  constexpr Id() = default;
  constexpr explicit Id(std::uint32_t v) : value(v) {}

  [[nodiscard]] constexpr bool valid() const { return value != kInvalidValue; }
  [[nodiscard]] constexpr std::size_t index() const { return value; }
  constexpr auto operator<=>(const Id&) const = default;
};

/// Position of a frame in its sequence, counted from 0 over the whole sequence.
using FrameId = Id<struct FrameTag>;
using KeyframeId = Id<struct KeyframeTag>;
using LandmarkId = Id<struct LandmarkTag>;
/// The coordinate frame shared by key frames that tracking, loops or relocalisation tie together.
/// Tracking that stays lost begins another submap.
using SubmapId = Id<struct SubmapTag>;

}  // namespace stillmap

template <class Tag>
struct std::hash<stillmap::Id<Tag>> {
  std::size_t operator()(stillmap::Id<Tag> id) const noexcept { return id.value; }
};
