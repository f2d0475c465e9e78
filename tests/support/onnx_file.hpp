// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace stillmap {

/// An output of a small network: fixed values, or the image itself where there are none.
struct OnnxOutput {
  std::string name;
  std::vector<std::int64_t> shape;
  std::vector<float> values;
};

/// A network of one image input, for tests.
struct OnnxFile {
  std::vector<std::int64_t> input;  ///< -1 for a size that is left open
  std::vector<OnnxOutput> outputs;
  std::vector<std::pair<std::string, std::string>> metadata = {};
  bool half_precision = false;  ///< of input and outputs

  /// The bytes of the network's file.
  [[nodiscard]] std::string bytes() const;
};

}  // namespace stillmap
