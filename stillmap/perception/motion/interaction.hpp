// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "stillmap/perception/detections/detections.hpp"
#include "stillmap/perception/objects/object_depth.hpp"

namespace stillmap {

/// How something that people move stands to the people of its frame.
enum class Contact : std::uint8_t {
  kBoxesApart,    ///< no box of a person intersects its box, Fan 2020, Eq. (8)
  kDepthsApart,   ///< boxes do, but one is behind the other, Eq. (9)
  kTouching,      ///< boxes intersect and depths overlap: they interact
  kDepthUnknown,  ///< boxes intersect, and one has no depth that could tell them apart: the same
};

/// Somebody or something of a frame.
struct ContactParty {
  PixelBox box;
  std::optional<DepthInterval> depths;  ///< of its mask without outliers; none where all is missing
};

struct Interaction {
  Contact contact = Contact::kBoxesApart;
  std::optional<std::size_t> person;  ///< which it touches, or which is before or behind it

  [[nodiscard]] bool interacts() const {
    return contact == Contact::kTouching || contact == Contact::kDepthUnknown;
  }
};

/// Whether a potentially dynamic object interacts with one of the people (Fan 2020, section 3,
/// Eqs. (8)-(9)). Who touches it for certain goes before who might, the first of several is named.
[[nodiscard]] Interaction judge_interaction(const ContactParty& object,
                                            std::span<const ContactParty> people);

}  // namespace stillmap
