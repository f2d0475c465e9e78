// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/motion/interaction.hpp"

#include "stillmap/perception/detections/box_overlap.hpp"

namespace stillmap {
namespace {

Contact contact_of(const ContactParty& object, const ContactParty& person) {
  if (shared_area(object.box, person.box) <= 0) return Contact::kBoxesApart;
  if (!object.depths || !person.depths) return Contact::kDepthUnknown;
  return object.depths->overlaps(*person.depths) ? Contact::kTouching : Contact::kDepthsApart;
}

/// The greater weight wins: certain contact before possible contact, and that before none.
int weight(Contact contact) {
  switch (contact) {
    case Contact::kTouching:
      return 3;
    case Contact::kDepthUnknown:
      return 2;
    case Contact::kDepthsApart:
      return 1;
    case Contact::kBoxesApart:
      break;
  }
  return 0;
}

}  // namespace

Interaction judge_interaction(const ContactParty& object, std::span<const ContactParty> people) {
  Interaction result;
  for (std::size_t i = 0; i < people.size(); ++i) {
    const Contact contact = contact_of(object, people[i]);
    if (weight(contact) > weight(result.contact)) result = {contact, i};
  }
  return result;
}

}  // namespace stillmap
