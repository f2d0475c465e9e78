// SPDX-License-Identifier: Apache-2.0
// Any bytes are decoded as a JPEG or refused.
#include "fuzz/harness.hpp"
#include "stillmap/io/jpeg_codec.hpp"

namespace stillmap::fuzz {
namespace {

// A small file can hold a large image: no more is decoded than a fuzzer has time for.
bool is_small(std::string_view bytes) {
  for (std::size_t i = 0; i + 9 < bytes.size(); ++i) {
    const auto byte = [&](std::size_t k) -> std::size_t {
      return static_cast<unsigned char>(bytes[i + k]);
    };
    const bool frame = byte(0) == 0xFF && byte(1) >= 0xC0 && byte(1) <= 0xCF;
    if (frame && (byte(5) << 8U | byte(6)) * (byte(7) << 8U | byte(8)) > 500000) return false;
  }
  return true;
}

void decode(std::string_view bytes) {
  if (!is_small(bytes)) return;
  read_or_refuse([&] {
    const DecodedJpeg jpeg = decode_jpeg(bytes, "input");
    require(!jpeg.rgb.empty(), "an image has pixels");
    require(jpeg.warning.find('\n') == std::string::npos, "one line of warning");
  });
}

}  // namespace
}  // namespace stillmap::fuzz

STILLMAP_FUZZER(stillmap::fuzz::decode)
