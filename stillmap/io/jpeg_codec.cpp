// SPDX-License-Identifier: Apache-2.0
#include "stillmap/io/jpeg_codec.hpp"

#include <algorithm>
#include <memory>

#include <turbojpeg.h>

#include "stillmap/core/error.hpp"
#include "stillmap/io/image_io.hpp"
#include "stillmap/io/png_codec.hpp"

namespace stillmap {
namespace {

struct DestroyHandle {
  void operator()(void* handle) const { tjDestroy(handle); }
};
using Handle = std::unique_ptr<void, DestroyHandle>;

struct FreeBuffer {
  void operator()(unsigned char* buffer) const { tjFree(buffer); }
};

const unsigned char* as_uchar(std::string_view bytes) {
  return reinterpret_cast<const unsigned char*>(bytes.data());
}

}  // namespace

bool is_jpeg(std::string_view bytes) {
  return bytes.starts_with("\xff\xd8\xff");
}

cv::Mat3b decode_jpeg(std::string_view bytes, const std::string& name) {
  if (!is_jpeg(bytes)) throw Error("{}: not a JPEG file", name);
  const Handle handle(tjInitDecompress());
  STILLMAP_CHECK(handle != nullptr);
  int width = 0, height = 0, subsampling = 0, colorspace = 0;
  if (tjDecompressHeader3(handle.get(),
                          as_uchar(bytes),
                          bytes.size(),
                          &width,
                          &height,
                          &subsampling,
                          &colorspace) != 0) {
    throw DamagedImage("{}: broken JPEG: {}", name, tjGetErrorStr2(handle.get()));
  }
  if (std::max(width, height) > kMaxImageSidePx) {
    throw Error("{}: {}x{} pixels, expected at most {}x{}",
                name,
                width,
                height,
                kMaxImageSidePx,
                kMaxImageSidePx);
  }
  if (colorspace == TJCS_CMYK || colorspace == TJCS_YCCK) {
    throw Error("{}: CMYK JPEG, expected gray or RGB", name);
  }
  cv::Mat3b rgb(height, width);
  // The library only warns of a truncated file and fills the rest with gray, so warnings are errors
  // here. The limit on scans refuses small files that take minutes to decode.
  if (tjDecompress2(handle.get(),
                    as_uchar(bytes),
                    bytes.size(),
                    rgb.ptr(),
                    width,
                    static_cast<int>(rgb.step[0]),
                    height,
                    TJPF_RGB,
                    TJFLAG_LIMITSCANS | TJFLAG_STOPONWARNING) != 0) {
    throw DamagedImage("{}: broken JPEG: {}", name, tjGetErrorStr2(handle.get()));
  }
  return rgb;
}

std::vector<std::uint8_t> encode_jpeg_bytes(const cv::Mat3b& rgb, int quality) {
  STILLMAP_CHECK(!rgb.empty() && quality >= 1 && quality <= 100);
  const Handle handle(tjInitCompress());
  STILLMAP_CHECK(handle != nullptr);
  unsigned char* buffer = nullptr;
  unsigned long size = 0;  // NOLINT(google-runtime-int): the library's type
  const int status = tjCompress2(handle.get(),
                                 rgb.ptr(),
                                 rgb.cols,
                                 static_cast<int>(rgb.step[0]),
                                 rgb.rows,
                                 TJPF_RGB,
                                 &buffer,
                                 &size,
                                 TJSAMP_444,
                                 quality,
                                 TJFLAG_ACCURATEDCT);
  const std::unique_ptr<unsigned char, FreeBuffer> owner(buffer);
  if (status != 0) {
    throw Error("cannot encode a {}x{} JPEG: {}", rgb.cols, rgb.rows, tjGetErrorStr2(handle.get()));
  }
  return {buffer, buffer + size};
}

}  // namespace stillmap
