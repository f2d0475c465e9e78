// SPDX-License-Identifier: Apache-2.0
// Any bytes are decoded as a PNG of each kind or refused; both decoders give the same pixels.
#include <cstring>
#include <optional>

#include "fuzz/harness.hpp"
#include "stillmap/io/plain_png.hpp"
#include "stillmap/io/png_codec.hpp"

namespace stillmap::fuzz {
namespace {

// A small file can hold a large image: no more is decoded than a fuzzer has time for.
bool is_small(std::string_view bytes) {
  if (bytes.size() < 24) return true;
  const auto side = [&](std::size_t at) {
    std::size_t value = 0;
    for (std::size_t i = at; i < at + 4; ++i) {
      value = value << 8U | static_cast<unsigned char>(bytes[i]);
    }
    return value;
  };
  return side(16) > 8192 || side(20) > 8192 || side(16) * side(20) < 1000000;
}

void decode(std::string_view bytes) {
  if (!is_small(bytes)) return;
  for (const PngKind kind : {PngKind::kRgb8, PngKind::kGray8, PngKind::kGray16}) {
    read_or_refuse([&] {
      const cv::Mat image = decode_png(bytes, kind, "input");
      require(!image.empty(), "an image has pixels");
    });
    if (!is_png(bytes)) continue;
    const std::optional<cv::Mat> plain = decode_plain_png(bytes, kind);
    if (!plain) continue;
    const cv::Mat image = decode_by_libpng(bytes, kind, "input");
    require(image.size() == plain->size() && image.type() == plain->type(), "the same kind");
    const std::size_t row_bytes = static_cast<std::size_t>(image.cols) * image.elemSize();
    for (int v = 0; v < image.rows; ++v) {
      require(std::memcmp(image.ptr(v), plain->ptr(v), row_bytes) == 0, "the same pixels");
    }
  }
}

}  // namespace
}  // namespace stillmap::fuzz

STILLMAP_FUZZER(stillmap::fuzz::decode)
