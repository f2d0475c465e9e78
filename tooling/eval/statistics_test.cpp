// SPDX-License-Identifier: Apache-2.0
#include "tooling/eval/statistics.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

TEST(Statistics, OfFourValues) {
  const Statistics s = statistics(std::vector<double>{4.0, 1.0, 2.0, 5.0});
  EXPECT_DOUBLE_EQ(s.rmse, std::sqrt(46.0 / 4.0));
  EXPECT_DOUBLE_EQ(s.mean, 3.0);
  EXPECT_DOUBLE_EQ(s.median, 3.0);  // between 2 and 4
  EXPECT_DOUBLE_EQ(s.std, std::sqrt((1.0 + 4.0 + 1.0 + 4.0) / 4.0));
  EXPECT_DOUBLE_EQ(s.min, 1.0);
  EXPECT_DOUBLE_EQ(s.max, 5.0);
}

TEST(Statistics, OfAnOddNumberAndOfOne) {
  EXPECT_DOUBLE_EQ(statistics(std::vector<double>{9.0, -1.0, 2.0}).median, 2.0);
  const Statistics one = statistics(std::vector<double>{-2.0});
  EXPECT_DOUBLE_EQ(one.rmse, 2.0);
  EXPECT_DOUBLE_EQ(one.mean, -2.0);
  EXPECT_DOUBLE_EQ(one.std, 0.0);
  EXPECT_DOUBLE_EQ(one.max, -2.0);
}

TEST(Statistics, OfNothingIsAMistake) {
  EXPECT_THROW((void)statistics({}), InternalError);
}

}  // namespace
}  // namespace stillmap
