// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "stillmap/perception/detections/detections.hpp"
#include "stillmap/perception/objects/object_depth.hpp"

namespace stillmap {

/// The contact of a potentially dynamic object with the people of its frame.
enum class Contact : std::uint8_t {
  kBoxesApart,    ///< no person's box intersects its box (Fan 2020, Eq. (8))
  kDepthsApart,   ///< boxes intersect, but depths do not overlap (Eq. (9))
  kTouching,      ///< boxes intersect and depths overlap: they interact
  kDepthUnknown,  ///< boxes intersect, and one has no depth: counts as contact
};

/// A person or an object of a frame.
struct ContactParty {
  PixelBox box;
  std::optional<DepthInterval> depths;  ///< of its mask without outliers; none without depth
};

struct Interaction {
  Contact contact = Contact::kBoxesApart;
  std::optional<std::size_t> person;  ///< the person in contact, or before or behind it

  [[nodiscard]] bool interacts() const {
    return contact == Contact::kTouching || contact == Contact::kDepthUnknown;
  }
};

/// Whether a potentially dynamic object interacts with a person (Fan 2020, section III-B, Eqs.
/// (8)-(9)). Certain contact is preferred to possible contact; the first of several people is
/// named.
[[nodiscard]] Interaction judge_interaction(const ContactParty& object,
                                            std::span<const ContactParty> people);

}  // namespace stillmap
