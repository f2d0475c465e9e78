// SPDX-License-Identifier: Apache-2.0
#include "tooling/pipeline/sample_log.hpp"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

namespace stillmap {
namespace {

// The ids of the samples kept in a run in which every third frame is dropped.
std::vector<std::uint32_t> samples_of(std::optional<std::size_t> total, std::uint32_t frames) {
  SampleLog log(total);
  for (std::uint32_t i = 0; i < frames; ++i) {
    RgbdFrame frame;
    frame.id = FrameId(i);
    frame.depth = DepthImage(cv::Mat1f(2, 2, 1.0F));
    i % 3 == 2 ? log.on_dropped(1) : log.on_frame(frame, {});
  }
  RunReport report;
  log.fill(report);
  std::vector<std::uint32_t> ids;
  for (const auto& [frame, result] : report.samples) {
    EXPECT_TRUE(frame.depth.mat.empty());
    ids.push_back(frame.id.value);
  }
  return ids;
}

TEST(SampleLog, SpreadsSamplesOverTheRun) {
  // Frames 9, 19, ... 79, except every third frame.
  EXPECT_EQ(samples_of(80, 80), (std::vector<std::uint32_t>{9, 19, 39, 49, 69, 79}));
}

TEST(SampleLog, ThinsSamplesOutWhereTheTotalIsNotKnown) {
  for (const std::uint32_t frames : {1U, 7U, 100U, 1000U}) {
    const std::vector<std::uint32_t> ids = samples_of(std::nullopt, frames);
    ASSERT_FALSE(ids.empty());
    EXPECT_LT(ids.size(), 16U);
    EXPECT_EQ(ids.front(), 0U);
    EXPECT_GE(ids.back(), frames / 2);
    EXPECT_TRUE(std::ranges::is_sorted(ids));
  }
}

}  // namespace
}  // namespace stillmap
