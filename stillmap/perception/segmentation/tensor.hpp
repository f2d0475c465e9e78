// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace stillmap {

using TensorShape = std::vector<std::int64_t>;

/// What a network takes or gives: numbers in the order of the shape, the last index running
/// fastest. The views of a Tensor live as long as it does.
struct TensorView {
  TensorShape shape;
  std::span<const float> values;  ///< as many as the shape says
};

struct Tensor {
  TensorShape shape;
  std::vector<float> values;

  [[nodiscard]] TensorView view() const { return {shape, values}; }
};

/// The number of values that a shape says; -1 when it is negative, or more than 2^28.
[[nodiscard]] std::int64_t element_count(const TensorShape& shape);

/// "1x3x416x416"
[[nodiscard]] std::string shape_text(const TensorShape& shape);

/// The shape without the ones at its front, but not fewer than `rank` sizes: networks give a batch
/// of one.
[[nodiscard]] TensorShape without_batch(const TensorShape& shape, std::size_t rank);

}  // namespace stillmap
