// SPDX-License-Identifier: Apache-2.0
#include "tests/support/onnx_file.hpp"

#include <cstring>
#include <string_view>

#include <opencv2/core.hpp>

namespace stillmap {
namespace {

// The encoding of Protocol Buffers: numbers with seven bits per byte, and texts with their lengths.
std::string varint(std::uint64_t value) {
  std::string bytes;
  for (; value >= 128; value /= 128) bytes += static_cast<char>(value % 128 + 128);
  return bytes + static_cast<char>(value);
}

std::string number(int field, std::int64_t value) {
  return varint(static_cast<std::uint64_t>(field) * 8) + varint(static_cast<std::uint64_t>(value));
}

std::string text(int field, std::string_view content) {
  return varint(static_cast<std::uint64_t>(field) * 8 + 2) + varint(content.size()) +
         std::string(content);
}

// Fields and types by their numbers in onnx.proto.
constexpr int kFloat = 1, kHalf = 10;

std::string value_info(const std::string& name, const std::vector<std::int64_t>& shape, int type) {
  std::string dimensions;
  for (std::size_t i = 0; i < shape.size(); ++i) {
    dimensions += text(1, shape[i] < 0 ? text(2, "open" + std::to_string(i)) : number(1, shape[i]));
  }
  return text(1, name) + text(2, text(1, number(1, type) + text(2, dimensions)));
}

std::string raw_values(const std::vector<float>& values, bool half) {
  cv::Mat stored = cv::Mat(values, true);
  if (half) stored.convertTo(stored, CV_16F);
  return {stored.ptr<char>(), stored.total() * stored.elemSize()};
}

std::string tensor(const OnnxOutput& output, bool half) {
  std::string bytes;
  for (const std::int64_t size : output.shape) bytes += number(1, size);
  return bytes + number(2, half ? kHalf : kFloat) + text(8, output.name + "_values") +
         text(9, raw_values(output.values, half));
}

}  // namespace

std::string OnnxFile::bytes() const {
  const int type = half_precision ? kHalf : kFloat;
  std::string graph = text(2, "g") + text(11, value_info("image", input, type));
  for (const OnnxOutput& output : outputs) {
    const bool is_image = output.values.empty();
    const std::string source = is_image ? "image" : output.name + "_values";
    graph += text(1, text(1, source) + text(2, output.name) + text(4, "Identity"));
    if (!is_image) graph += text(5, tensor(output, half_precision));
    graph += text(12, value_info(output.name, output.shape, type));
  }
  std::string model = number(1, 8) + text(7, graph) + text(8, text(1, "") + number(2, 13));
  for (const auto& [key, value] : metadata) model += text(14, text(1, key) + text(2, value));
  return model;
}

}  // namespace stillmap
