// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/segmentation/network.hpp"

#include <utility>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

// Outputs of another first size, such as a table of anchors, belong to no image of the batch.
void keep_first_image(Tensor& output, std::int64_t batch) {
  if (output.shape.empty() || output.shape[0] != batch) return;
  output.shape[0] = 1;
  output.values.resize(output.values.size() / static_cast<std::size_t>(batch));
}

}  // namespace

std::vector<Tensor> run_on_image(const Network& network, Tensor input, std::int64_t batch) {
  STILLMAP_CHECK(batch > 0 && !input.shape.empty() && input.shape[0] == 1);
  input.shape[0] = batch;
  input.values.resize(input.values.size() * static_cast<std::size_t>(batch));
  std::vector<Tensor> outputs = network.run(input);
  for (Tensor& output : outputs) keep_first_image(output, batch);
  return outputs;
}

}  // namespace stillmap
