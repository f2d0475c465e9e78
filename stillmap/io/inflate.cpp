// SPDX-License-Identifier: Apache-2.0
#include "stillmap/io/inflate.hpp"

#include <memory>

#include <libdeflate.h>

namespace stillmap {
namespace {

constexpr std::size_t kMaxExpansion = 1032;  // greatest expansion of a deflate stream

struct Release {
  void operator()(libdeflate_decompressor* decompressor) const {
    libdeflate_free_decompressor(decompressor);
  }
};

}  // namespace

std::optional<std::vector<std::uint8_t>> inflate_whole(std::string_view stream, std::size_t size) {
  if (size / kMaxExpansion > stream.size()) return std::nullopt;
  const std::unique_ptr<libdeflate_decompressor, Release> decompressor(
      libdeflate_alloc_decompressor());
  if (decompressor == nullptr) return std::nullopt;
  std::vector<std::uint8_t> out(size);
  std::size_t read = 0;
  const libdeflate_result result = libdeflate_zlib_decompress_ex(
      decompressor.get(), stream.data(), stream.size(), out.data(), out.size(), &read, nullptr);
  if (result != LIBDEFLATE_SUCCESS || read != stream.size()) return std::nullopt;
  return out;
}

}  // namespace stillmap
