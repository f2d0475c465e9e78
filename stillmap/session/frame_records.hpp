// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "stillmap/core/ids.hpp"
#include "stillmap/core/trajectory.hpp"
#include "stillmap/io/scratch_file.hpp"

namespace stillmap {

/// The pose of a tracked frame relative to a key frame, so that later optimisation moves it. The
/// key frame may have been removed since.
struct FrameRecord {
  Stamp stamp;
  KeyframeId reference;
  Eigen::Isometry3d T_reference_frame = Eigen::Isometry3d::Identity();
};

/// A list of frame records that takes no more memory however long a run is: the last
/// kInMemory to kInMemory + kBlock records are in memory, earlier ones in a ScratchFile.
/// Records are given and taken as values. A copy shares what is unchanged, in memory and on the
/// disk; one thread at a time uses a list and its copies.
class FrameRecords {
 public:
  static constexpr std::size_t kBlock = 1024;
  /// More than the smoothing of trajectories looks back over.
  static constexpr std::size_t kInMemory = 12 * kBlock;

  class Iterator;

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  // NOLINTBEGIN(readability-const-return-type): whoever tries to change a copy is told so.
  [[nodiscard]] const FrameRecord operator[](std::size_t i) const;
  [[nodiscard]] const FrameRecord front() const { return (*this)[0]; }
  [[nodiscard]] const FrameRecord back() const { return (*this)[size_ - 1]; }
  // NOLINTEND(readability-const-return-type)
  /// Going through many records this way reads the disk once for each kBlock of them.
  [[nodiscard]] Iterator begin() const;
  [[nodiscard]] Iterator end() const;
  /// From a record on; the end where there are fewer.
  [[nodiscard]] Iterator from(std::size_t i) const;
  /// The number of records in memory.
  [[nodiscard]] std::size_t in_memory() const;

  void push_back(FrameRecord record);
  void set(std::size_t i, FrameRecord record);

 private:
  /// kBlock records, the last block fewer: in memory, or on the disk.
  struct Block {
    std::vector<FrameRecord> records;  // empty: on the disk
    std::size_t place = 0;             // in the file
    std::size_t record_bytes = 0;      // in the file, of each
  };

  [[nodiscard]] Block& writable(std::size_t block);
  [[nodiscard]] std::shared_ptr<Block> moved_to_disk(const Block& block);
  void spill();

  std::vector<std::shared_ptr<Block>> blocks_;  // of this list alone before they are changed
  std::size_t size_ = 0;
  std::shared_ptr<ScratchFile> file_;  // null until there are more records than stay in memory
};

class FrameRecords::Iterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using difference_type = std::ptrdiff_t;
  using value_type = FrameRecord;
  using pointer = const FrameRecord*;
  using reference = FrameRecord;

  Iterator(const FrameRecords& records, std::size_t i) : records_(&records), i_(i) {}
  [[nodiscard]] FrameRecord operator*() const;
  Iterator& operator++() {
    ++i_;
    return *this;
  }
  [[nodiscard]] bool operator==(const Iterator& other) const { return i_ == other.i_; }

 private:
  const FrameRecords* records_;
  std::size_t i_;
  // The bytes of a block on the disk.
  mutable std::string bytes_;
  mutable std::size_t block_ = static_cast<std::size_t>(-1);
};

inline FrameRecords::Iterator FrameRecords::begin() const {
  return from(0);
}
inline FrameRecords::Iterator FrameRecords::end() const {
  return from(size_);
}
inline FrameRecords::Iterator FrameRecords::from(std::size_t i) const {
  return {*this, std::min(i, size_)};
}

}  // namespace stillmap
