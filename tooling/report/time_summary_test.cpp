// SPDX-License-Identifier: Apache-2.0
#include "tooling/report/time_summary.hpp"

#include <limits>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

namespace stillmap {
namespace {

TEST(TimeSummary, OfNothingIsNothing) {
  EXPECT_FALSE(summarize_times({}).has_value());
  const std::vector<double> not_finite{std::numeric_limits<double>::quiet_NaN(),
                                       std::numeric_limits<double>::infinity()};
  EXPECT_FALSE(summarize_times(not_finite).has_value());
}

TEST(TimeSummary, OfOneValueIsThatValue) {
  const std::vector<double> one{7.5};
  const TimeSummary summary = summarize_times(one).value();
  EXPECT_EQ(summary.mean, 7.5);
  EXPECT_EQ(summary.median, 7.5);
  EXPECT_EQ(summary.p95, 7.5);
  EXPECT_EQ(summary.max, 7.5);
}

TEST(TimeSummary, HandWorked) {
  const std::vector<double> values{40, 10, 30, 20};
  const TimeSummary summary = summarize_times(values).value();
  EXPECT_DOUBLE_EQ(summary.mean, 25);
  EXPECT_DOUBLE_EQ(summary.median, 25);
  EXPECT_DOUBLE_EQ(summary.p95, 40);
  EXPECT_DOUBLE_EQ(summary.max, 40);
}

TEST(TimeSummary, P95IsTheNearestRank) {
  std::vector<double> values(100);
  std::iota(values.rbegin(), values.rend(), 1.0);
  EXPECT_EQ(summarize_times(values)->p95, 95);  // rank ceil(0.95 * 100) = 95 of 1..100
  values.resize(20);                            // 81..100
  EXPECT_EQ(summarize_times(values)->p95, 99);  // rank 19
  values.push_back(80);
  EXPECT_EQ(summarize_times(values)->p95, 99);  // rank ceil(19.95) = 20 of 80..100
}

}  // namespace
}  // namespace stillmap
