// SPDX-License-Identifier: Apache-2.0
#include "stillmap/io/jpeg_codec.hpp"

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include <jpeglib.h>
// After jpeglib.h, whose types it needs.
#include <jerror.h>

#include "stillmap/core/error.hpp"
#include "stillmap/io/image_io.hpp"
#include "stillmap/io/png_codec.hpp"

namespace stillmap {
namespace {

// libjpeg reports an error by a call that must not return. It ends in a long jump, which skips
// destructors. Every call of libjpeg is therefore made in a small member function that sets the
// jump, has no objects of its own and returns whether the call succeeded.
struct JpegErrors {
  jpeg_error_mgr library;  // first, so that the library's pointer is one to the whole
  std::jmp_buf jump;
  std::array<char, JMSG_LENGTH_MAX> error, warning;
  bool lacks_end;
};

JpegErrors& errors_of(j_common_ptr codec) {
  return *reinterpret_cast<JpegErrors*>(codec->err);
}

void on_jpeg_error(j_common_ptr codec) {
  JpegErrors& errors = errors_of(codec);
  codec->err->format_message(codec, errors.error.data());
  std::longjmp(errors.jump, 1);
}

// What the library only warns of is an error where pixels are missing or guessed.
void on_jpeg_message(j_common_ptr codec, int level) {
  if (level >= 0) return;
  JpegErrors& errors = errors_of(codec);
  const int code = codec->err->msg_code;
  if (code != JWRN_EXTRANEOUS_DATA && code != JWRN_JPEG_EOF && code != JWRN_ADOBE_XFORM) {
    on_jpeg_error(codec);
  }
  errors.lacks_end = errors.lacks_end || code == JWRN_JPEG_EOF;
  if (errors.warning[0] == '\0') codec->err->format_message(codec, errors.warning.data());
}

void init(JpegErrors& errors) {
  jpeg_std_error(&errors.library);
  errors.library.error_exit = on_jpeg_error;
  errors.library.emit_message = on_jpeg_message;
  errors.error.fill('\0');
  errors.warning.fill('\0');
  errors.lacks_end = false;
}

class JpegReader {
 public:
  JpegReader() {
    init(errors_);
    codec_.err = &errors_.library;
    progress_.progress_monitor = on_progress;
  }
  JpegReader(const JpegReader&) = delete;
  JpegReader& operator=(const JpegReader&) = delete;
  ~JpegReader() { jpeg_destroy_decompress(&codec_); }

  [[nodiscard]] bool read_header(std::string_view bytes) {
    if (setjmp(errors_.jump) != 0) return false;
    jpeg_create_decompress(&codec_);
    codec_.progress = &progress_;
    jpeg_mem_src(&codec_, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
    return jpeg_read_header(&codec_, TRUE) == JPEG_HEADER_OK;
  }

  [[nodiscard]] std::uint32_t width() const { return codec_.image_width; }
  [[nodiscard]] std::uint32_t height() const { return codec_.image_height; }
  [[nodiscard]] bool is_cmyk() const {
    return codec_.jpeg_color_space == JCS_CMYK || codec_.jpeg_color_space == JCS_YCCK;
  }

  // `row_bytes` is the size of the caller's rows.
  [[nodiscard]] bool read_pixels(unsigned char* rows, std::size_t row_bytes) {
    if (setjmp(errors_.jump) != 0) return false;
    codec_.out_color_space = JCS_RGB;
    jpeg_start_decompress(&codec_);
    while (codec_.output_scanline < codec_.output_height) {
      JSAMPROW row = rows + row_bytes * codec_.output_scanline;
      jpeg_read_scanlines(&codec_, &row, 1);
    }
    return !lacks_scans() && jpeg_finish_decompress(&codec_) == TRUE;
  }

  [[nodiscard]] std::string error() const {
    return errors_.error[0] == '\0' ? "the file ends too early" : errors_.error.data();
  }
  [[nodiscard]] std::string warning() const { return errors_.warning.data(); }

 private:
  // A small file with thousands of scans would take minutes.
  static void on_progress(j_common_ptr codec) {
    constexpr int kMostScans = 500;
    JpegErrors& errors = errors_of(codec);
    if (reinterpret_cast<j_decompress_ptr>(codec)->input_scan_number <= kMostScans) return;
    std::snprintf(errors.error.data(), errors.error.size(), "more than %d scans", kMostScans);
    std::longjmp(errors.jump, 1);
  }

  // Where the file ends between two scans, or in one with arithmetic coding, no pixel is reported
  // missing although all are coarse, or some are.
  [[nodiscard]] bool lacks_scans() const {
    if (!errors_.lacks_end) return false;
    if (codec_.arith_code == TRUE || codec_.coef_bits == nullptr) {
      return codec_.arith_code == TRUE || codec_.comps_in_scan < codec_.num_components;
    }
    for (int component = 0; component < codec_.num_components; ++component) {
      const auto& bits = codec_.coef_bits[component];
      if (!std::ranges::all_of(bits, [](int bit) { return bit == 0; })) return true;
    }
    return false;
  }

  JpegErrors errors_ = {};
  jpeg_progress_mgr progress_ = {};
  jpeg_decompress_struct codec_ = {};
};

class JpegWriter {
 public:
  JpegWriter() {
    init(errors_);
    codec_.err = &errors_.library;
  }
  JpegWriter(const JpegWriter&) = delete;
  JpegWriter& operator=(const JpegWriter&) = delete;
  ~JpegWriter() {
    jpeg_destroy_compress(&codec_);
    std::free(bytes_);
  }

  [[nodiscard]] bool write(cv::Mat3b& rgb, int quality) {
    if (setjmp(errors_.jump) != 0) return false;
    jpeg_create_compress(&codec_);
    jpeg_mem_dest(&codec_, &bytes_, &size_);
    codec_.image_width = static_cast<JDIMENSION>(rgb.cols);
    codec_.image_height = static_cast<JDIMENSION>(rgb.rows);
    codec_.input_components = 3;
    codec_.in_color_space = JCS_RGB;
    jpeg_set_defaults(&codec_);
    jpeg_set_quality(&codec_, quality, TRUE);
    codec_.comp_info[0].h_samp_factor = codec_.comp_info[0].v_samp_factor = 1;
    jpeg_start_compress(&codec_, TRUE);
    while (codec_.next_scanline < codec_.image_height) {
      JSAMPROW row = rgb.ptr(static_cast<int>(codec_.next_scanline));
      jpeg_write_scanlines(&codec_, &row, 1);
    }
    jpeg_finish_compress(&codec_);
    return true;
  }

  [[nodiscard]] std::vector<std::uint8_t> bytes() const { return {bytes_, bytes_ + size_}; }
  [[nodiscard]] std::string error() const { return errors_.error.data(); }

 private:
  JpegErrors errors_ = {};
  jpeg_compress_struct codec_ = {};
  unsigned char* bytes_ = nullptr;
  unsigned long size_ = 0;  // NOLINT(google-runtime-int): the library's type
};

}  // namespace

bool is_jpeg(std::string_view bytes) {
  return bytes.starts_with("\xff\xd8\xff");
}

DecodedJpeg decode_jpeg(std::string_view bytes, const std::string& name) {
  if (!is_jpeg(bytes)) throw Error("{}: not a JPEG file", name);
  JpegReader reader;
  if (!reader.read_header(bytes)) throw DamagedImage("{}: broken JPEG: {}", name, reader.error());
  if (std::max(reader.width(), reader.height()) > static_cast<std::uint32_t>(kMaxImageSidePx)) {
    throw Error("{}: {}x{} pixels, expected at most {}x{}",
                name,
                reader.width(),
                reader.height(),
                kMaxImageSidePx,
                kMaxImageSidePx);
  }
  if (reader.is_cmyk()) throw Error("{}: CMYK JPEG, expected gray or RGB", name);
  cv::Mat3b rgb(static_cast<int>(reader.height()), static_cast<int>(reader.width()));
  if (!reader.read_pixels(rgb.ptr(), rgb.step[0])) {
    throw DamagedImage("{}: broken JPEG: {}", name, reader.error());
  }
  return {rgb, reader.warning()};
}

std::vector<std::uint8_t> encode_jpeg_bytes(const cv::Mat3b& rgb, int quality) {
  STILLMAP_CHECK(!rgb.empty() && quality >= 1 && quality <= 100);
  // libjpeg's interface asks for writable rows but does not write to them
  cv::Mat3b same_pixels = rgb;
  JpegWriter writer;
  if (!writer.write(same_pixels, quality)) {
    throw Error("cannot encode a {}x{} JPEG: {}", rgb.cols, rgb.rows, writer.error());
  }
  return writer.bytes();
}

}  // namespace stillmap
