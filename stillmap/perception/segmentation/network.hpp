// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "stillmap/perception/segmentation/tensor.hpp"

namespace stillmap {

struct NamedShape {
  std::string name;
  TensorShape shape;  ///< -1 for a size that the network leaves open
};

/// The inputs, outputs and class names that a network declares.
struct NetworkSignature {
  std::vector<NamedShape> inputs;
  std::vector<NamedShape> outputs;
  std::string class_names;  ///< the metadata entry `names`; empty if there is none
  std::string task;         ///< the metadata entry `task` of Ultralytics' exports; or empty
};

/// A network with one image input. run() may be called from several threads and gives the same bits
/// for the same input.
class Network {
 public:
  Network() = default;
  Network(const Network&) = delete;
  Network& operator=(const Network&) = delete;
  virtual ~Network() = default;

  [[nodiscard]] virtual const NetworkSignature& signature() const = 0;

  /// The outputs, in the order of the signature. Throws Error, naming the network, when the run
  /// fails.
  [[nodiscard]] virtual std::vector<Tensor> run(const Tensor& input) const = 0;
};

/// Runs a network on one image, `input`, and gives the outputs for it. Networks that take `batch`
/// images at once get it as the first, the others empty.
[[nodiscard]] std::vector<Tensor> run_on_image(const Network& network,
                                               Tensor input,
                                               std::int64_t batch);

}  // namespace stillmap
