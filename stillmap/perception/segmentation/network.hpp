// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "stillmap/perception/segmentation/tensor.hpp"

namespace stillmap {

struct NamedShape {
  std::string name;
  TensorShape shape;  ///< -1 for a size that the network leaves open
};

/// What a network says of itself.
struct NetworkSignature {
  std::vector<NamedShape> inputs;
  std::vector<NamedShape> outputs;
  std::string class_names;  ///< its metadata's entry `names`; empty when it has none
};

/// A network with one image as its input. run() may be called from several threads, and gives the
/// same bits for the same input.
class Network {
 public:
  Network() = default;
  Network(const Network&) = delete;
  Network& operator=(const Network&) = delete;
  virtual ~Network() = default;

  [[nodiscard]] virtual const NetworkSignature& signature() const = 0;

  /// The outputs in the signature's order. Throws Error, naming the network, when it cannot be run.
  [[nodiscard]] virtual std::vector<Tensor> run(const Tensor& input) const = 0;
};

}  // namespace stillmap
