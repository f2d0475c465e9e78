// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/motion/interaction.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace stillmap {
namespace {

const ContactParty kChair{{100, 100, 200, 200}, DepthInterval{1.5F, 2.0F}};

TEST(Interaction, NobodyThere) {
  const Interaction none = judge_interaction(kChair, {});
  EXPECT_EQ(none.contact, Contact::kBoxesApart);
  EXPECT_FALSE(none.person);
  EXPECT_FALSE(none.interacts());
}

TEST(Interaction, BoxesThatOnlyTouchAreApart) {
  const std::vector<ContactParty> people{{{200, 100, 300, 200}, DepthInterval{1.5F, 2.0F}}};
  EXPECT_EQ(judge_interaction(kChair, people).contact, Contact::kBoxesApart);
}

TEST(Interaction, BeforeOrBehindIsApart) {
  for (const DepthInterval depths : {DepthInterval{0.8F, 1.4F}, DepthInterval{2.1F, 2.6F}}) {
    const std::vector<ContactParty> people{{{150, 50, 300, 200}, depths}};
    const Interaction judged = judge_interaction(kChair, people);
    EXPECT_EQ(judged.contact, Contact::kDepthsApart);
    EXPECT_EQ(judged.person, 0U);
    EXPECT_FALSE(judged.interacts());
  }
}

TEST(Interaction, DepthsThatMeetInAPointTouch) {
  // By Eq. (9), intervals are apart only if strictly so.
  const std::vector<ContactParty> people{{{150, 50, 300, 200}, DepthInterval{2.0F, 2.6F}}};
  EXPECT_EQ(judge_interaction(kChair, people).contact, Contact::kTouching);
}

TEST(Interaction, WithoutDepthOfEitherItMayBe) {
  const std::vector<ContactParty> unknown{{{150, 50, 300, 200}, std::nullopt}};
  EXPECT_EQ(judge_interaction(kChair, unknown).contact, Contact::kDepthUnknown);
  EXPECT_TRUE(judge_interaction(kChair, unknown).interacts());
  const std::vector<ContactParty> known{{{150, 50, 300, 200}, DepthInterval{5, 6}}};
  EXPECT_TRUE(judge_interaction({kChair.box, std::nullopt}, known).interacts());
  const std::vector<ContactParty> elsewhere{{{0, 0, 50, 50}, std::nullopt}};
  EXPECT_FALSE(judge_interaction(kChair, elsewhere).interacts());
}

TEST(Interaction, WhoTouchesForCertainIsNamed) {
  const std::vector<ContactParty> people{{{0, 0, 50, 50}, DepthInterval{1.5F, 2.0F}},
                                         {{150, 50, 300, 200}, DepthInterval{3.0F, 4.0F}},
                                         {{150, 50, 300, 200}, std::nullopt},
                                         {{150, 50, 300, 200}, DepthInterval{1.9F, 2.4F}},
                                         {{150, 50, 300, 200}, DepthInterval{1.6F, 1.7F}}};
  const Interaction judged = judge_interaction(kChair, people);
  EXPECT_EQ(judged.contact, Contact::kTouching);
  EXPECT_EQ(judged.person, 3U);
}

}  // namespace
}  // namespace stillmap
