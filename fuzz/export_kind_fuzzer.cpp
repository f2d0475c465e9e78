// SPDX-License-Identifier: Apache-2.0
// Whatever a network's file says of its inputs, outputs and classes, the network is identified,
// with outputs that exist and usable names, or refused.
#include "fuzz/harness.hpp"
#include "stillmap/perception/detections/class_names.hpp"
#include "stillmap/perception/segmentation/export_kind.hpp"

namespace stillmap::fuzz {
namespace {

// Takes numbers from the front of the bytes; 0 at the end.
class Numbers {
 public:
  explicit Numbers(std::string_view bytes) : rest_(bytes) {}
  [[nodiscard]] int byte() {
    if (rest_.empty()) return 0;
    const int value = static_cast<unsigned char>(rest_.front());
    rest_.remove_prefix(1);
    return value;
  }
  [[nodiscard]] TensorShape shape() {
    TensorShape shape(static_cast<std::size_t>(byte() % 6));
    for (std::int64_t& size : shape) {
      const int kind = byte();
      size = kind < 200 ? kind : kind < 250 ? 256 * (kind - 200) + byte() : kind - 252;
    }
    return shape;
  }

 private:
  std::string_view rest_;
};

void identify(std::string_view bytes) {
  const std::vector<std::string_view> parts = parts_of(bytes, 3);
  Numbers numbers(parts[2]);
  NetworkSignature signature;
  signature.class_names = parts[0];
  signature.task = parts[1];
  signature.inputs.resize(static_cast<std::size_t>(numbers.byte() % 3));
  for (NamedShape& input : signature.inputs) input.shape = numbers.shape();
  std::vector<Tensor> outputs(static_cast<std::size_t>(numbers.byte() % 8));
  for (Tensor& output : outputs) {
    output.shape = numbers.shape();
    const std::int64_t count = element_count(output.shape);
    if (count < 0 || count > 20000) return;
    const int low = numbers.byte(), step = numbers.byte();
    for (std::int64_t i = 0; i < count; ++i) {
      output.values.push_back(static_cast<float>((low + i * step) % 256) / 16.F - 4.F);
    }
  }
  read_or_refuse([&] {
    const TensorShape input = image_input_shape(signature, {640, 480});
    require(input.size() == 4 && element_count(input) > 0, "an input of one image");
  });
  read_or_refuse([&] {
    const NetworkExport network = identify_export(signature, outputs, {64, 64});
    for (const std::size_t output : network.outputs) require(output < outputs.size(), "an output");
    for (const std::string& name : network.names) require(is_class_name(name), "a name of a class");
  });
}

}  // namespace
}  // namespace stillmap::fuzz

STILLMAP_FUZZER(stillmap::fuzz::identify)
