// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace stillmap {

using TensorShape = std::vector<std::int64_t>;

/// The values of an input or output of a network, in the order of the shape, with the last index
/// running fastest. A view must not outlive its Tensor.
struct TensorView {
  TensorShape shape;
  std::span<const float> values;  ///< element_count(shape) of them
};

struct Tensor {
  TensorShape shape;
  std::vector<float> values;

  [[nodiscard]] TensorView view() const { return {shape, values}; }
};

/// The number of values of a shape; -1 if it has a negative size or more than 2^28 values.
[[nodiscard]] std::int64_t element_count(const TensorShape& shape);

/// The shape as text: "1x3x416x416".
[[nodiscard]] std::string shape_text(const TensorShape& shape);

/// The shape without leading ones, but with at least `rank` sizes. Networks give batches of one.
[[nodiscard]] TensorShape without_batch(const TensorShape& shape, std::size_t rank);

}  // namespace stillmap
