// SPDX-License-Identifier: Apache-2.0
#include "stillmap/io/png_codec.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <csetjmp>
#include <cstring>
#include <optional>
#include <vector>

#include <png.h>
#include <zlib.h>

#include "stillmap/core/error.hpp"
#include "stillmap/io/image_io.hpp"
#include "stillmap/io/plain_png.hpp"

namespace stillmap {
namespace {

// libpng reports an error by a long jump, which skips destructors. Every call of libpng is
// therefore made in a small member function that sets the jump, has no objects of its own and
// returns whether the call succeeded. The text of the error is kept in a plain array.
struct ErrorText {
  std::array<char, 128> text = {};
};

void on_error(png_structp png, png_const_charp message) {
  ErrorText& error = *static_cast<ErrorText*>(png_get_error_ptr(png));
  std::strncpy(error.text.data(), message, error.text.size() - 1);
  png_longjmp(png, 1);
}

void on_warning(png_structp, png_const_charp) {}  // damage outside the pixels does not matter

class PngReader {
 public:
  explicit PngReader(std::string_view bytes) : rest_(bytes) {
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, &error_, on_error, on_warning);
    STILLMAP_CHECK(png_ != nullptr);
    info_ = png_create_info_struct(png_);
    STILLMAP_CHECK(info_ != nullptr);
    png_set_read_fn(png_, this, on_read);
  }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }

  [[nodiscard]] bool read_header() {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_set_user_limits(
        png_, PNG_UINT_31_MAX, PNG_UINT_31_MAX);  // the limit of the caller gives a better message
    png_read_info(png_, info_);
    return true;
  }

  [[nodiscard]] std::uint32_t width() const { return png_get_image_width(png_, info_); }
  [[nodiscard]] std::uint32_t height() const { return png_get_image_height(png_, info_); }
  [[nodiscard]] int bit_depth() const { return png_get_bit_depth(png_, info_); }
  [[nodiscard]] int color_type() const { return png_get_color_type(png_, info_); }

  // Makes libpng deliver rows of the kind. `row_bytes` is the size of the caller's rows.
  [[nodiscard]] bool start(PngKind kind, std::size_t row_bytes) {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    if (kind == PngKind::kRgb8) {
      png_set_strip_alpha(png_);
      if ((color_type() & PNG_COLOR_MASK_COLOR) == 0) png_set_gray_to_rgb(png_);
    }
    if (kind == PngKind::kGray16 && std::endian::native == std::endian::little) png_set_swap(png_);
    png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    return png_get_rowbytes(png_, info_) == row_bytes;
  }

  // Reads all rows and the chunks after them, so that truncation anywhere is noticed.
  [[nodiscard]] bool read_rows(png_bytep* rows) {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_read_image(png_, rows);
    png_read_end(png_, nullptr);
    return true;
  }

  [[nodiscard]] std::string error() const { return error_.text.data(); }

 private:
  static void on_read(png_structp png, png_bytep target, std::size_t size) {
    PngReader& self = *static_cast<PngReader*>(png_get_io_ptr(png));
    if (size > self.rest_.size()) png_error(png, "the file ends too early");
    std::memcpy(target, self.rest_.data(), size);
    self.rest_.remove_prefix(size);
  }

  std::string_view rest_;
  ErrorText error_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
};

class PngWriter {
 public:
  PngWriter() {
    png_ = png_create_write_struct(PNG_LIBPNG_VER_STRING, &error_, on_error, on_warning);
    STILLMAP_CHECK(png_ != nullptr);
    info_ = png_create_info_struct(png_);
    STILLMAP_CHECK(info_ != nullptr);
    png_set_write_fn(png_, this, on_write, nullptr);
  }
  PngWriter(const PngWriter&) = delete;
  PngWriter& operator=(const PngWriter&) = delete;
  ~PngWriter() { png_destroy_write_struct(&png_, &info_); }

  [[nodiscard]] bool write(const cv::Mat& image, png_bytep* rows) {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_set_IHDR(png_,
                 info_,
                 static_cast<png_uint_32>(image.cols),
                 static_cast<png_uint_32>(image.rows),
                 image.depth() == CV_16U ? 16 : 8,
                 image.channels() == 3 ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_GRAY,
                 PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    // Noisy photographs have no repetitions: run-length coding and one filter give files as small
    // as the default settings do, in a fifth of the time.
    png_set_filter(png_, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
    png_set_compression_level(png_, 1);
    if (image.channels() == 3) png_set_compression_strategy(png_, Z_RLE);
    png_write_info(png_, info_);
    if (image.depth() == CV_16U && std::endian::native == std::endian::little) png_set_swap(png_);
    png_write_image(png_, rows);
    png_write_end(png_, nullptr);
    return true;
  }

  [[nodiscard]] std::string take() { return std::move(bytes_); }
  [[nodiscard]] std::string error() const { return error_.text.data(); }

 private:
  static void on_write(png_structp png, png_bytep data, std::size_t size) {
    PngWriter& self = *static_cast<PngWriter*>(png_get_io_ptr(png));
    if (!self.append(data, size)) png_error(png, "out of memory");
  }

  [[nodiscard]] bool append(const png_byte* data, std::size_t size) noexcept {
    try {
      bytes_.append(data, data + size);
      return true;
    } catch (const std::bad_alloc&) {  // exceptions must not pass through C code
      return false;
    }
  }

  std::string bytes_;
  ErrorText error_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
};

std::string describe(const PngReader& reader) {
  const int color = reader.color_type();
  const std::string bits = fmt::format("{}-bit ", reader.bit_depth());
  if (color == PNG_COLOR_TYPE_PALETTE) return bits + "palette";
  const std::string alpha = (color & PNG_COLOR_MASK_ALPHA) != 0 ? " with transparency" : "";
  return bits + ((color & PNG_COLOR_MASK_COLOR) != 0 ? "RGB" : "gray") + alpha;
}

void check_kind(const PngReader& reader, PngKind kind, const std::string& name) {
  const int color = reader.color_type();
  const int bits = reader.bit_depth();
  if (kind == PngKind::kRgb8 && (bits != 8 || color == PNG_COLOR_TYPE_PALETTE)) {
    throw Error("{}: {} PNG, expected 8-bit gray or RGB", name, describe(reader));
  }
  if (kind == PngKind::kGray8 && (bits != 8 || color != PNG_COLOR_TYPE_GRAY)) {
    throw Error("{}: {} PNG, expected 8-bit gray", name, describe(reader));
  }
  if (kind == PngKind::kGray16 && (bits != 16 || color != PNG_COLOR_TYPE_GRAY)) {
    throw Error("{}: {} PNG, expected 16-bit gray (depth)", name, describe(reader));
  }
}

int mat_type(PngKind kind) {
  if (kind == PngKind::kRgb8) return CV_8UC3;
  return kind == PngKind::kGray8 ? CV_8UC1 : CV_16UC1;
}

std::vector<png_bytep> row_pointers(cv::Mat& image) {
  std::vector<png_bytep> rows(static_cast<std::size_t>(image.rows));
  for (int v = 0; v < image.rows; ++v) rows[static_cast<std::size_t>(v)] = image.ptr(v);
  return rows;
}

}  // namespace

bool is_png(std::string_view bytes) {
  return bytes.starts_with("\x89PNG\r\n\x1a\n");
}

cv::Mat decode_png(std::string_view bytes, PngKind kind, const std::string& name) {
  if (!is_png(bytes)) throw Error("{}: not a PNG file", name);
  // A second decoder, as it saves 3 % of a run's processor time on depth images and as much again
  // where the colour images are PNG too (docs/benchmarks.md, "Reading PNG").
  if (const std::optional<cv::Mat> plain = decode_plain_png(bytes, kind)) return *plain;
  return decode_by_libpng(bytes, kind, name);
}

cv::Mat decode_by_libpng(std::string_view bytes, PngKind kind, const std::string& name) {
  PngReader reader(bytes);
  if (!reader.read_header()) throw DamagedImage("{}: broken PNG: {}", name, reader.error());
  if (std::max(reader.width(), reader.height()) > static_cast<std::uint32_t>(kMaxImageSidePx)) {
    throw Error("{}: {}x{} pixels, expected at most {}x{}",
                name,
                reader.width(),
                reader.height(),
                kMaxImageSidePx,
                kMaxImageSidePx);
  }
  check_kind(reader, kind, name);
  cv::Mat image(
      static_cast<int>(reader.height()), static_cast<int>(reader.width()), mat_type(kind));
  STILLMAP_CHECK(image.isContinuous());
  std::vector<png_bytep> rows = row_pointers(image);
  if (!reader.start(kind, image.step[0]) || !reader.read_rows(rows.data())) {
    throw DamagedImage("{}: broken PNG: {}", name, reader.error());
  }
  return image;
}

std::string encode_png_bytes(const cv::Mat& image) {
  const int type = image.type();
  STILLMAP_CHECK(!image.empty() && (type == CV_8UC3 || type == CV_8UC1 || type == CV_16UC1));
  cv::Mat same_pixels =
      image;  // libpng's interface asks for writable rows but does not write to them
  std::vector<png_bytep> rows = row_pointers(same_pixels);
  PngWriter writer;
  if (!writer.write(image, rows.data())) {
    throw Error("cannot encode a {}x{} PNG: {}", image.cols, image.rows, writer.error());
  }
  return writer.take();
}

}  // namespace stillmap
