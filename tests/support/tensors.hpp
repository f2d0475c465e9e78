// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "stillmap/perception/segmentation/tensor.hpp"

namespace stillmap {

inline Tensor zeros(const TensorShape& shape) {
  return {shape, std::vector<float>(static_cast<std::size_t>(element_count(shape)))};
}

}  // namespace stillmap
