// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/segmentation/tensor.hpp"

#include <string>
#include <vector>

#include "stillmap/core/joined.hpp"

namespace stillmap {

std::int64_t element_count(const TensorShape& shape) {
  constexpr std::int64_t kMost = std::int64_t{1} << 28;
  std::int64_t count = 1;
  for (const std::int64_t size : shape) {
    if (size < 0 || size > kMost) return -1;
    count *= size;
    if (count > kMost) return -1;
  }
  return count;
}

std::string shape_text(const TensorShape& shape) {
  std::vector<std::string> sizes;
  for (const std::int64_t size : shape) sizes.push_back(std::to_string(size));
  return joined(sizes, "x");
}

TensorShape without_batch(const TensorShape& shape, std::size_t rank) {
  std::size_t first = 0;
  while (shape.size() - first > rank && shape[first] == 1) ++first;
  return {shape.begin() + static_cast<std::ptrdiff_t>(first), shape.end()};
}

}  // namespace stillmap
