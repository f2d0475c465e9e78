// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace stillmap {

struct IndexedKey {
  std::uint64_t key = 0;
  std::uint32_t index = 0;
};

/// The keys in ascending order; equal keys stay in the order given. Takes linear time (radix sort).
[[nodiscard]] std::vector<IndexedKey> sorted_by_key(std::vector<IndexedKey> keys);

}  // namespace stillmap
