// SPDX-License-Identifier: Apache-2.0
#include "stillmap/session/frame_records.hpp"

#include <random>

#include <gtest/gtest.h>

namespace stillmap {
namespace {

FrameRecord some_record(std::uint32_t i) {
  std::mt19937 rng(i);
  std::normal_distribution<double> number;
  FrameRecord record;
  record.stamp = {i / 30.0, std::string(rng() % 20, 'x') + std::to_string(i)};
  record.reference = KeyframeId(rng());
  for (double& value : record.T_reference_frame.matrix().reshaped()) value = number(rng);
  return record;
}

void expect_same(const FrameRecord& record, const FrameRecord& truth) {
  ASSERT_EQ(record.stamp.text, truth.stamp.text);
  ASSERT_EQ(record.stamp.seconds, truth.stamp.seconds);
  ASSERT_EQ(record.reference, truth.reference);
  ASSERT_EQ(record.T_reference_frame.matrix(), truth.T_reference_frame.matrix());
}

FrameRecords some_records(std::uint32_t count) {
  FrameRecords records;
  for (std::uint32_t i = 0; i < count; ++i) {
    EXPECT_EQ(records.size(), i);
    records.push_back(some_record(i));
    EXPECT_LE(records.in_memory(), FrameRecords::kInMemory + FrameRecords::kBlock);
  }
  return records;
}

constexpr auto kMany = static_cast<std::uint32_t>(2 * FrameRecords::kInMemory + 5);

TEST(FrameRecords, GivesBackWhatItWasGivenFromMemoryAndDisk) {
  const FrameRecords records = some_records(kMany);
  ASSERT_LT(records.in_memory(), records.size());
  for (std::uint32_t i = 0; i < kMany; ++i) expect_same(records[i], some_record(i));
  std::uint32_t number = 0;
  for (const FrameRecord record : records) expect_same(record, some_record(number++));
  EXPECT_EQ(number, kMany);
  expect_same(records.front(), some_record(0));
  expect_same(records.back(), some_record(kMany - 1));
  expect_same(*records.from(1500), some_record(1500));
  EXPECT_TRUE(records.from(kMany + 1) == records.end());
}

TEST(FrameRecords, ChangesOfACopyAreItsOwn) {
  FrameRecords records = some_records(kMany);
  FrameRecords copy = records;
  for (const std::uint32_t i : {0U, 5000U, kMany - 1}) copy.set(i, some_record(i + 1));
  copy.push_back(some_record(7));
  records.push_back(some_record(8));
  for (const std::uint32_t i : {0U, 1U, 5000U, kMany - 2, kMany - 1}) {
    expect_same(records[i], some_record(i));
    expect_same(copy[i], some_record(i == 1 || i == kMany - 2 ? i : i + 1));
  }
  expect_same(copy.back(), some_record(7));
  expect_same(records.back(), some_record(8));
}

TEST(FrameRecords, ChangedRecordsGoToTheDiskAgain) {
  FrameRecords records = some_records(kMany);
  for (std::uint32_t i = 0; i < 4000; ++i) records.set(i, some_record(i + 9));
  for (std::uint32_t i = kMany; i < kMany + FrameRecords::kBlock; ++i)
    records.push_back(some_record(i));
  EXPECT_LE(records.in_memory(), FrameRecords::kInMemory + FrameRecords::kBlock);
  for (std::uint32_t i = 0; i < kMany; ++i)
    expect_same(records[i], some_record(i < 4000 ? i + 9 : i));
}

}  // namespace
}  // namespace stillmap
