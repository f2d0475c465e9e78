// SPDX-License-Identifier: Apache-2.0
#include "stillmap/io/image_io.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <random>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <png.h>

#include "stillmap/core/rgbd_frame.hpp"
#include "stillmap/io/png_codec.hpp"
#include "tests/support/files.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

ColorImage random_color(int width, int height) {
  std::mt19937 rng(7);
  cv::Mat3b rgb(height, width);
  for (cv::Vec3b& pixel : rgb) {
    for (int c = 0; c < 3; ++c) pixel[c] = static_cast<std::uint8_t>(rng());
  }
  return ColorImage(rgb);
}

// Smooth, as photographs are, so that JPEG keeps it.
ColorImage smooth_color(int width, int height) {
  cv::Mat3b rgb(height, width);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      rgb(v, u) = cv::Vec3b(static_cast<std::uint8_t>(255 * u / width),
                            static_cast<std::uint8_t>(255 * v / height),
                            static_cast<std::uint8_t>(255 * (width - u) / width));
    }
  }
  return ColorImage(rgb);
}

bool same(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0.0;
}

fs::path write(const TemporaryFolder& folder, const std::string& name, std::string_view bytes) {
  std::ofstream(folder.path() / name, std::ios::binary) << bytes;
  return folder.path() / name;
}

std::string as_string(const std::vector<std::uint8_t>& bytes) {
  return {bytes.begin(), bytes.end()};
}

// A PNG from libpng's other, simplified interface: written by code that is not under test.
std::string simple_png(png_uint_32 format, int width, int height, const void* pixels) {
  png_image image = {};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width);
  image.height = static_cast<png_uint_32>(height);
  image.format = format;
  std::string bytes(100000, '\0');
  png_alloc_size_t size = bytes.size();
  STILLMAP_CHECK(png_image_write_to_memory(&image, bytes.data(), &size, 0, pixels, 0, nullptr));
  bytes.resize(size);
  return bytes;
}

std::uint32_t crc32_of(std::string_view bytes) {
  std::uint32_t crc = 0xffffffffU;
  for (const char c : bytes) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1U) ^ ((crc & 1U) != 0 ? 0xedb88320U : 0U);
  }
  return ~crc;
}

void put_big_endian(std::string& bytes, std::size_t at, std::uint32_t value) {
  for (int i = 0; i < 4; ++i) bytes[at + i] = static_cast<char>(value >> (24 - 8 * i));
}

// Says another size in the header, with a checksum that is right.
std::string claim_size(std::string png, std::uint32_t width, std::uint32_t height) {
  put_big_endian(png, 16, width);
  put_big_endian(png, 20, height);
  put_big_endian(png, 29, crc32_of(std::string_view(png).substr(12, 17)));
  return png;
}

TEST(ReadColor, GivesBackThePixelsOfAPng) {
  const TemporaryFolder folder;
  const ColorImage image = random_color(31, 17);
  const fs::path path = write(folder, "a.png", encode_png(image));
  EXPECT_TRUE(same(read_color(path).mat, image.mat));
}

TEST(ReadColor, ReadsPngsOfOtherMakers) {
  const TemporaryFolder folder;
  const std::array<std::uint8_t, 8> rgba = {255, 0, 10, 255, 1, 2, 3, 0};
  const cv::Mat3b from_rgba =
      read_color(write(folder, "a", simple_png(PNG_FORMAT_RGBA, 2, 1, rgba.data()))).mat;
  EXPECT_EQ(from_rgba(0, 0), cv::Vec3b(255, 0, 10));
  EXPECT_EQ(from_rgba(0, 1), cv::Vec3b(1, 2, 3));
  const std::array<std::uint8_t, 2> gray = {7, 200};
  const cv::Mat3b from_gray =
      read_color(write(folder, "b", simple_png(PNG_FORMAT_GRAY, 2, 1, gray.data()))).mat;
  EXPECT_EQ(from_gray(0, 0), cv::Vec3b(7, 7, 7));
  EXPECT_EQ(from_gray(0, 1), cv::Vec3b(200, 200, 200));
}

TEST(ReadColor, ReadsAJpegWhateverItsName) {
  const TemporaryFolder folder;
  const ColorImage image = smooth_color(64, 48);
  const fs::path path = write(folder, "a.png", as_string(encode_jpeg(image, 95)));
  const ColorImage read = read_color(path);
  ASSERT_EQ(read.mat.size(), image.mat.size());
  EXPECT_LE(cv::norm(read.mat, image.mat, cv::NORM_INF), 6.0);  // also tells RGB from BGR
}

TEST(DecodeColor, ReadsBytesAndNamesThem) {
  const ColorImage color = random_color(13, 7);
  const std::string png = encode_png(color);
  EXPECT_TRUE(same(decode_color(png, "a.zip: b").mat, color.mat));
  try {
    (void)decode_color(std::string_view(png).substr(0, png.size() / 2), "a.zip: b");
    FAIL();
  } catch (const DamagedImage& error) {
    EXPECT_THAT(error.what(), HasSubstr("a.zip: b"));
  }
  EXPECT_THROW((void)decode_color("", "a.zip: b"), DamagedImage);
}

TEST(ReadColor, RefusesEveryTruncationOfAPng) {
  const TemporaryFolder folder;
  const std::string bytes = encode_png(random_color(20, 20));
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const fs::path path = write(folder, "a.png", std::string_view(bytes).substr(0, size));
    ASSERT_THAT(error_of([&] { (void)read_color(path); }), HasSubstr("a.png")) << size;
  }
}

// Only what has all pixels is read: a file without its end marker.
TEST(ReadColor, RefusesEveryTruncationOfAJpegThatCostsPixels) {
  const TemporaryFolder folder;
  const std::string bytes = as_string(encode_jpeg(random_color(12, 12), 90));
  const cv::Mat3b whole = read_color(write(folder, "whole.jpg", bytes)).mat;
  EXPECT_EQ(read_color_file(folder.path() / "whole.jpg").warning, "");
  int refused = 0;
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const fs::path path = write(folder, "a.jpg", std::string_view(bytes).substr(0, size));
    try {
      const ColorFile read = read_color_file(path);
      EXPECT_TRUE(same(read.color.mat, whole)) << size;
      EXPECT_THAT(read.warning, HasSubstr("a.jpg: Premature end of JPEG file")) << size;
    } catch (const DamagedImage& damage) {
      EXPECT_THAT(damage.what(), HasSubstr("a.jpg")) << size;
      ++refused;
    }
  }
  EXPECT_GE(refused, static_cast<int>(bytes.size()) - 3);
  EXPECT_LE(refused, static_cast<int>(bytes.size()) - 2);
}

// What cameras with motion JPEG send: all pixels are there.
TEST(ReadColor, ReadsAJpegThatLacksNoPixel) {
  const TemporaryFolder folder;
  const std::string bytes = as_string(encode_jpeg(smooth_color(64, 48), 90));
  const std::string body = bytes.substr(0, bytes.size() - 2), end = bytes.substr(bytes.size() - 2);
  const cv::Mat3b whole = read_color(write(folder, "whole.jpg", bytes)).mat;
  const std::string stray = body + "stray" + end, padded = bytes + std::string(512, '\0');
  for (const std::string& odd : {body, stray, body + std::string(100, '\0') + end, padded}) {
    const ColorFile read = read_color_file(write(folder, "odd.jpg", odd));
    EXPECT_TRUE(same(read.color.mat, whole)) << odd.size();
    EXPECT_EQ(read.warning.empty(), odd == padded) << read.warning;  // nobody reads past the end
  }
}

// Bytes changed in the pixels themselves.
TEST(ReadColor, RefusesAJpegWhosePixelsAreGuessed) {
  const TemporaryFolder folder;
  std::string bytes = as_string(encode_jpeg(random_color(64, 48), 90));
  const std::size_t scan = bytes.find("\xff\xda");
  ASSERT_NE(scan, std::string::npos);
  std::string cut = bytes;
  cut.erase(bytes.size() / 2, 200);  // the scan ends too early, the end marker is there
  EXPECT_THAT(error_of([&] { (void)read_color(write(folder, "cut.jpg", cut)); }),
              HasSubstr("broken JPEG"));
  bytes.replace(scan + 500, 2, "\xff\xd3");  // a restart marker where none is due
  EXPECT_THAT(error_of([&] { (void)read_color(write(folder, "marker.jpg", bytes)); }),
              HasSubstr("broken JPEG"));
}

TEST(ReadColor, RefusesDamage) {
  const TemporaryFolder folder;
  std::string png = encode_png(random_color(20, 20));
  png[png.size() / 2] = static_cast<char>(png[png.size() / 2] ^ 0x55);
  const fs::path path = write(folder, "a.png", png);
  EXPECT_THAT(error_of([&] { (void)read_color(path); }), HasSubstr("broken PNG"));
}

TEST(ReadColor, RefusesAHugeSizeByItsHeader) {
  const TemporaryFolder folder;
  const std::string png = claim_size(encode_png(random_color(4, 4)), 60000, 60000);
  EXPECT_THAT(error_of([&] { (void)read_color(write(folder, "a", png)); }),
              HasSubstr("60000x60000 pixels, expected at most 8192x8192"));
  const std::string wider = claim_size(encode_png(random_color(4, 4)), 0x7fffffff, 1);
  EXPECT_THAT(error_of([&] { (void)read_color(write(folder, "a", wider)); }), HasSubstr("a: "));
  std::string jpeg = as_string(encode_jpeg(random_color(16, 16), 90));
  const std::size_t frame = jpeg.find("\xff\xc0");  // start of frame: length, bits, height, width
  ASSERT_NE(frame, std::string::npos);
  put_big_endian(jpeg, frame + 5, 0xea60ea60U);
  EXPECT_THAT(error_of([&] { (void)read_color(write(folder, "a", jpeg)); }),
              HasSubstr("60000x60000 pixels, expected at most 8192x8192"));
}

TEST(ReadColor, RefusesOtherKinds) {
  const TemporaryFolder folder;
  const std::string depth = encode_depth_png(DepthImage(cv::Mat1f(2, 2, 1.0F)), 5000);
  EXPECT_THAT(error_of([&] { (void)read_color(write(folder, "a", depth)); }),
              HasSubstr("16-bit gray PNG, expected 8-bit gray or RGB"));
  EXPECT_THAT(error_of([&] { (void)read_color(write(folder, "a", "GIF89a")); }),
              HasSubstr("neither PNG nor JPEG"));
  EXPECT_THAT(error_of([&] { (void)read_color(write(folder, "a", "")); }), HasSubstr("empty"));
  EXPECT_THAT(error_of([&] { (void)read_color(folder.path() / "none.png"); }),
              HasSubstr("none.png"));
}

TEST(ReadDepth, DividesByTheFactorAndKeepsMissing) {
  const TemporaryFolder folder;
  cv::Mat1w raw(2, 3);
  raw << 0, 1, 5000, 65535, 12345, 258;
  const fs::path path = write(folder, "d.png", encode_png_bytes(raw));
  const cv::Mat1f metres = read_depth(path, 5000).mat;
  ASSERT_EQ(metres.size(), raw.size());
  for (int i = 0; i < 6; ++i) {
    const std::uint16_t stored = raw(i / 3, i % 3);
    const float expected = stored == 65535 ? 0.0F : static_cast<float>(stored) / 5000.0F;
    EXPECT_EQ(metres(i / 3, i % 3), expected);
  }
}

TEST(ReadDepth, ReadsBigEndianSamplesAsOtherMakersWriteThem) {
  const TemporaryFolder folder;
  const std::array<std::uint16_t, 2> linear = {0x0102, 0xff00};
  const fs::path path = write(folder, "d", simple_png(PNG_FORMAT_LINEAR_Y, 2, 1, linear.data()));
  const cv::Mat1f metres = read_depth(path, 1).mat;
  EXPECT_EQ(metres(0, 0), 258.0F);
  EXPECT_EQ(metres(0, 1), 65280.0F);
}

TEST(ReadDepth, RefusesColourAndJpegAndTruncation) {
  const TemporaryFolder folder;
  EXPECT_THAT(
      error_of([&] { (void)read_depth(write(folder, "a", encode_png(random_color(2, 2))), 5000); }),
      HasSubstr("8-bit RGB PNG, expected 16-bit gray"));
  EXPECT_THAT(error_of([&] {
                const std::string jpeg = as_string(encode_jpeg(random_color(8, 8), 90));
                (void)read_depth(write(folder, "a", jpeg), 5000);
              }),
              HasSubstr("not a PNG"));
  const std::string depth = encode_depth_png(DepthImage(cv::Mat1f(40, 40, 1.0F)), 5000);
  for (std::size_t size = 0; size < depth.size(); ++size) {
    const fs::path path = write(folder, "d.png", std::string_view(depth).substr(0, size));
    ASSERT_THAT(error_of([&] { (void)read_depth(path, 5000); }), HasSubstr("d.png")) << size;
  }
}

TEST(EncodeDepthPng, RoundsAndDropsWhatHasNoValue) {
  const TemporaryFolder folder;
  cv::Mat1f metres(1, 7);
  metres << 1.23456F, -1.0F, std::numeric_limits<float>::quiet_NaN(),
      std::numeric_limits<float>::infinity(), 14.0F, 13.107F, 13.1068F;
  const fs::path path = write(folder, "d", encode_depth_png(DepthImage(metres), 5000));
  const cv::Mat1f read = read_depth(path, 5000).mat;
  EXPECT_EQ(read(0, 0), 6173.0F / 5000.0F);
  EXPECT_EQ(read(0, 1), 0.0F);
  EXPECT_EQ(read(0, 2), 0.0F);
  EXPECT_EQ(read(0, 3), 0.0F);
  EXPECT_EQ(read(0, 4), 0.0F);  // 70000 does not fit
  EXPECT_EQ(read(0, 5), 0.0F);  // 65535 would mean that nothing was measured
  EXPECT_EQ(read(0, 6), 65534.0F / 5000.0F);
}

TEST(ReadMask, GivesBackIdsAndRefusesOtherKinds) {
  const TemporaryFolder folder;
  cv::Mat1b ids(2, 2);
  ids << 0, 1, 99, 255;
  EXPECT_TRUE(same(read_mask(write(folder, "m", encode_mask_png(ids))), ids));
  EXPECT_THAT(
      error_of([&] { (void)read_mask(write(folder, "m", encode_png(random_color(2, 2)))); }),
      HasSubstr("expected 8-bit gray"));
}

TEST(ToGray, IsBt601) {
  cv::Mat3b rgb(1, 4);
  rgb(0, 0) = {255, 0, 0};
  rgb(0, 1) = {0, 255, 0};
  rgb(0, 2) = {0, 0, 255};
  rgb(0, 3) = {255, 255, 255};
  const cv::Mat1b gray = to_gray(ColorImage(rgb)).mat;
  EXPECT_EQ(gray(0, 0), 76);   // 0.299 * 255 = 76.2
  EXPECT_EQ(gray(0, 1), 150);  // 0.587 * 255 = 149.7
  EXPECT_EQ(gray(0, 2), 29);   // 0.114 * 255 = 29.07
  EXPECT_EQ(gray(0, 3), 255);
}

}  // namespace
}  // namespace stillmap
