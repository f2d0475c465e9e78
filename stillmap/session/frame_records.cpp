// SPDX-License-Identifier: Apache-2.0
#include "stillmap/session/frame_records.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

// A record in the file: these, then the text of its stamp, filled up to the longest of its block.
struct Numbers {
  double stamp_s = 0;
  std::array<double, 16> T_reference_frame{};
  std::uint32_t reference = 0;
  std::uint32_t text_bytes = 0;
};

std::size_t record_bytes(const std::vector<FrameRecord>& records) {
  std::size_t text = 0;
  for (const FrameRecord& record : records) text = std::max(text, record.stamp.text.size());
  return sizeof(Numbers) + text;
}

void append_record(std::string& bytes, const FrameRecord& record, std::size_t record_bytes) {
  Numbers numbers;
  numbers.stamp_s = record.stamp.seconds;
  std::copy_n(record.T_reference_frame.data(),
              numbers.T_reference_frame.size(),
              &numbers.T_reference_frame[0]);
  numbers.reference = record.reference.value;
  numbers.text_bytes = static_cast<std::uint32_t>(record.stamp.text.size());
  const std::size_t end = bytes.size() + record_bytes;
  bytes.append(reinterpret_cast<const char*>(&numbers), sizeof numbers);
  bytes += record.stamp.text;
  bytes.resize(end);
}

FrameRecord record_of(std::string_view bytes) {
  Numbers numbers;
  STILLMAP_CHECK(bytes.size() >= sizeof numbers);
  std::memcpy(&numbers, bytes.data(), sizeof numbers);
  FrameRecord record;
  record.stamp.seconds = numbers.stamp_s;
  record.stamp.text = bytes.substr(sizeof numbers, numbers.text_bytes);
  record.reference = KeyframeId(numbers.reference);
  std::ranges::copy(numbers.T_reference_frame, record.T_reference_frame.data());
  return record;
}

}  // namespace

// NOLINTNEXTLINE(readability-const-return-type)
const FrameRecord FrameRecords::operator[](std::size_t i) const {
  STILLMAP_CHECK(i < size_);
  const Block& block = *blocks_[i / kBlock];
  if (!block.records.empty()) return block.records[i % kBlock];
  const std::size_t bytes = block.record_bytes;
  return record_of(file_->read(block.place + i % kBlock * bytes, bytes));
}

FrameRecord FrameRecords::Iterator::operator*() const {
  const std::size_t at = i_ / kBlock;
  const Block& block = *records_->blocks_[at];
  if (!block.records.empty()) return block.records[i_ % kBlock];
  if (block_ != at) {
    bytes_ = records_->file_->read(block.place, kBlock * block.record_bytes);
    block_ = at;
  }
  return record_of(std::string_view(bytes_).substr(i_ % kBlock * block.record_bytes));
}

std::size_t FrameRecords::in_memory() const {
  std::size_t count = 0;
  for (const auto& block : blocks_) count += block->records.size();
  return count;
}

void FrameRecords::push_back(FrameRecord record) {
  if (size_ % kBlock == 0) {
    spill();
    blocks_.push_back(std::make_shared<Block>());
    writable(blocks_.size() - 1).records.reserve(kBlock);
  }
  writable(blocks_.size() - 1).records.push_back(std::move(record));
  ++size_;
}

void FrameRecords::set(std::size_t i, FrameRecord record) {
  STILLMAP_CHECK(i < size_);
  writable(i / kBlock).records[i % kBlock] = std::move(record);
}

// The block in memory, shared with no copy of this list.
FrameRecords::Block& FrameRecords::writable(std::size_t block) {
  std::shared_ptr<Block>& shared = blocks_[block];
  const bool on_disk = shared->records.empty() && shared->record_bytes > 0;
  if (on_disk || shared.use_count() > 1) {
    auto own = std::make_shared<Block>();
    own->records.reserve(kBlock);
    const std::size_t first = block * kBlock;
    const Iterator last = from(first + kBlock);
    for (Iterator at = from(first); at != last; ++at) own->records.push_back(*at);
    shared = std::move(own);
  }
  return *shared;
}

std::shared_ptr<FrameRecords::Block> FrameRecords::moved_to_disk(const Block& block) {
  auto moved = std::make_shared<Block>();
  moved->record_bytes = record_bytes(block.records);
  std::string bytes;
  bytes.reserve(block.records.size() * moved->record_bytes);
  for (const FrameRecord& record : block.records) append_record(bytes, record, moved->record_bytes);
  if (!file_) file_ = std::make_shared<ScratchFile>();
  moved->place = file_->append(bytes);
  return moved;
}

void FrameRecords::spill() {
  const std::size_t kept = kInMemory / kBlock;
  for (std::size_t i = 0; i + kept < blocks_.size(); ++i) {
    if (!blocks_[i]->records.empty()) blocks_[i] = moved_to_disk(*blocks_[i]);
  }
}

}  // namespace stillmap
