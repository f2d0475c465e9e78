// SPDX-License-Identifier: Apache-2.0
#include "stillmap/io/plain_png.hpp"

#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <png.h>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

struct Writing {
  int color = PNG_COLOR_TYPE_RGB;
  int bits = 8;
  int interlace = PNG_INTERLACE_NONE;
  int filters = PNG_ALL_FILTERS;
  std::size_t chunk_bytes = 8192;
};

// By libpng. `rows` are as the file has them, samples of 16 bits with the high byte first.
std::string png_of(cv::Size size, std::vector<std::vector<png_byte>> rows, Writing how) {
  std::string bytes;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(
      png,
      &bytes,
      [](png_structp p, png_bytep data, std::size_t count) {
        static_cast<std::string*>(png_get_io_ptr(p))->append(data, data + count);
      },
      nullptr);
  png_set_IHDR(png,
               info,
               static_cast<png_uint_32>(size.width),
               static_cast<png_uint_32>(size.height),
               how.bits,
               how.color,
               how.interlace,
               PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_set_filter(png, PNG_FILTER_TYPE_BASE, how.filters);
  png_set_compression_buffer_size(png, how.chunk_bytes);
  png_set_gAMA(png, info, 0.45);  // a chunk that says nothing of the pixels
  png_write_info(png, info);
  std::vector<png_bytep> pointers;
  for (std::vector<png_byte>& row : rows) pointers.push_back(row.data());
  png_write_image(png, pointers.data());
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return bytes;
}

// Slopes with noise, for every filter to have its day.
std::vector<std::vector<png_byte>> picture(cv::Size size, int pixel_bytes, std::mt19937& rng) {
  std::vector<std::vector<png_byte>> rows;
  const unsigned noise = 1U << rng() % 8, slope = rng() % 5;
  for (int v = 0; v < size.height; ++v) {
    rows.emplace_back();
    for (int i = 0; i < size.width * pixel_bytes; ++i) {
      const auto at = static_cast<unsigned>(v + i / pixel_bytes);
      rows.back().push_back(static_cast<png_byte>(at * slope + rng() % noise));
    }
  }
  return rows;
}

bool same(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0.0;
}

struct Sort {
  PngKind kind;
  int color, bits, pixel_bytes;
};

constexpr Sort kSorts[] = {{PngKind::kRgb8, PNG_COLOR_TYPE_RGB, 8, 3},
                           {PngKind::kGray8, PNG_COLOR_TYPE_GRAY, 8, 1},
                           {PngKind::kGray16, PNG_COLOR_TYPE_GRAY, 16, 2}};

TEST(DecodePlainPng, GivesThePixelsThatLibpngGives) {
  std::mt19937 rng(1);
  for (const Sort& sort : kSorts) {
    for (const int filters : {PNG_FILTER_NONE,
                              PNG_FILTER_SUB,
                              PNG_FILTER_UP,
                              PNG_FILTER_AVG,
                              PNG_FILTER_PAETH,
                              PNG_ALL_FILTERS}) {
      for (const cv::Size size : {cv::Size(1, 1), cv::Size(1, 40), cv::Size(333, 57)}) {
        const std::string png = png_of(
            size, picture(size, sort.pixel_bytes, rng), {sort.color, sort.bits, 0, filters, 500});
        const std::optional<cv::Mat> plain = decode_plain_png(png, sort.kind);
        ASSERT_TRUE(plain);
        EXPECT_TRUE(same(*plain, decode_by_libpng(png, sort.kind, "a.png"))) << filters;
      }
    }
  }
}

TEST(DecodePlainPng, LeavesOtherSortsAlone) {
  std::mt19937 rng(2);
  const cv::Size size(20, 10);
  const std::string rgb = png_of(size, picture(size, 3, rng), {});
  EXPECT_TRUE(decode_plain_png(rgb, PngKind::kRgb8));
  EXPECT_FALSE(decode_plain_png(rgb, PngKind::kGray8));
  EXPECT_FALSE(decode_plain_png(rgb, PngKind::kGray16));
  EXPECT_FALSE(decode_plain_png("GIF89a", PngKind::kRgb8));
  const std::string rgba = png_of(size, picture(size, 4, rng), {.color = PNG_COLOR_TYPE_RGBA});
  EXPECT_FALSE(decode_plain_png(rgba, PngKind::kRgb8));
  const std::string interlaced =
      png_of(size, picture(size, 3, rng), {.interlace = PNG_INTERLACE_ADAM7});
  EXPECT_FALSE(decode_plain_png(interlaced, PngKind::kRgb8));
  EXPECT_FALSE(decode_by_libpng(interlaced, PngKind::kRgb8, "a.png").empty());
}

TEST(DecodePlainPng, TakesNothingCutShort) {
  std::mt19937 rng(3);
  const std::string png = png_of({20, 10}, picture({20, 10}, 3, rng), {.chunk_bytes = 100});
  for (std::size_t size = 0; size < png.size(); ++size) {
    ASSERT_FALSE(decode_plain_png(std::string_view(png).substr(0, size), PngKind::kRgb8)) << size;
  }
}

TEST(DecodePlainPng, TakesNothingDamaged) {
  std::mt19937 rng(4);
  for (int trial = 0; trial < 3000; ++trial) {
    const Sort& sort = kSorts[rng() % 3];
    const cv::Size size(1 + static_cast<int>(rng() % 20), 1 + static_cast<int>(rng() % 20));
    std::string png = png_of(
        size, picture(size, sort.pixel_bytes, rng), {.color = sort.color, .bits = sort.bits});
    const std::size_t at = rng() % png.size();
    png[at] = static_cast<char>(static_cast<unsigned>(png[at]) ^ (1U << rng() % 8));
    ASSERT_FALSE(decode_plain_png(png, sort.kind)) << trial << ": byte " << at;
  }
}

}  // namespace
}  // namespace stillmap
