// SPDX-License-Identifier: Apache-2.0
#include "stillmap/io/scratch_records.hpp"

#include <cstdint>
#include <cstring>
#include <limits>

#include "stillmap/core/append_bytes.hpp"
#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

constexpr std::size_t kBuffer = 64U << 10U;
constexpr std::size_t kSizeBytes = sizeof(std::uint32_t);

// Visits the whole records at the beginning of `bytes` and removes them.
void take_whole(std::string& bytes, const std::function<void(std::string_view)>& visit) {
  std::string_view rest = bytes;
  while (rest.size() >= kSizeBytes) {
    std::uint32_t size = 0;
    std::memcpy(&size, rest.data(), kSizeBytes);
    if (size > rest.size() - kSizeBytes) break;
    visit(rest.substr(kSizeBytes, size));
    rest.remove_prefix(kSizeBytes + size);
  }
  bytes.erase(0, bytes.size() - rest.size());
}

}  // namespace

void ScratchRecords::push_back(std::string_view record) {
  STILLMAP_CHECK(record.size() <= std::numeric_limits<std::uint32_t>::max());
  append_bytes(buffer_, static_cast<std::uint32_t>(record.size()));
  buffer_ += record;
  if (buffer_.size() < kBuffer) return;
  if (!file_) file_ = std::make_unique<ScratchFile>();
  file_->append(buffer_);
  buffer_.clear();
}

void ScratchRecords::visit(const std::function<void(std::string_view record)>& visit) const {
  std::string bytes;
  for (std::size_t at = 0; file_;) {
    const std::string piece = file_->read(at, kBuffer);
    if (piece.empty()) break;
    at += piece.size();
    bytes += piece;
    take_whole(bytes, visit);
  }
  bytes += buffer_;
  take_whole(bytes, visit);
  STILLMAP_CHECK(bytes.empty());
}

}  // namespace stillmap
