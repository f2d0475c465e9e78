// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "stillmap/io/scratch_file.hpp"

namespace stillmap {

/// Records that are only needed at the end of a long run. All but the last few kB lie in a
/// ScratchFile.
class ScratchRecords {
 public:
  /// Adds a record of less than 4 GB. Throws Error when the disk takes no more.
  void push_back(std::string_view record);
  /// Calls `visit` with each record, in order. Throws Error when they cannot be read back.
  void visit(const std::function<void(std::string_view record)>& visit) const;
  /// The number of bytes in memory.
  [[nodiscard]] std::size_t buffered() const { return buffer_.size(); }

 private:
  std::unique_ptr<ScratchFile> file_;  // null until there are more bytes than the buffer takes
  std::string buffer_;                 // follows what is in the file
};

}  // namespace stillmap
