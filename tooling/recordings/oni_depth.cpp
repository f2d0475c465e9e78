// SPDX-License-Identifier: Apache-2.0
#include "tooling/recordings/oni_depth.hpp"

#include <cstdint>
#include <cstring>
#include <optional>
#include <vector>

#include "stillmap/core/error.hpp"
#include "stillmap/io/image_io.hpp"

namespace stillmap {
namespace {

/// The pixels of an image whose codes are differences to the pixel before. A byte is
/// - below 0xE0: two differences, each of them 6 less one of its halves. A lower half 0xD stands
///   for none, 0xF for what the next bytes say as after 0xFF;
/// - 0xE0 to 0xFE: twice as many pixels as it is above 0xE0, all as the last;
/// - 0xFF: before a difference of 7 bits (192 less the next byte, where that is 128 or more), or
///   before a value of 15 bits.
class DifferenceCodes {
 public:
  DifferenceCodes(std::string_view bytes, const std::string& place) : rest_(bytes), place_(place) {}

  void read_table() {
    const std::size_t count = word();
    if (count == 0 || count * 2 > rest_.size()) fail();
    table_.emplace(count);
    std::memcpy(table_->data(), rest_.data(), count * 2);
    rest_.remove_prefix(count * 2);
  }

  [[nodiscard]] cv::Mat1w pixels(cv::Size size) {
    constexpr int kRuns = 0xE0, kLong = 0xFF;
    pixels_.create(size);
    last_ = word();
    put();
    while (!rest_.empty()) {
      const int code = byte();
      if (code < kRuns) {
        step(6 - (code >> 4));
        take_lower(code & 0xF);
      } else if (code == kLong) {
        take_long();
      } else {
        for (int i = 0; i < 2 * (code - kRuns); ++i) put();
      }
    }
    if (written_ != pixels_.total()) fail();
    return pixels_;
  }

 private:
  [[noreturn]] void fail() const { throw DamagedImage("{}: damaged depth", place_); }

  [[nodiscard]] int byte() {
    if (rest_.empty()) fail();
    const auto value = static_cast<std::uint8_t>(rest_.front());
    rest_.remove_prefix(1);
    return value;
  }
  [[nodiscard]] std::uint16_t word() {
    const int low = byte();
    return static_cast<std::uint16_t>(low | byte() << 8);
  }
  void take_lower(int half) {
    constexpr int kMostStep = 0xC, kNothing = 0xD, kLongFollows = 0xF;
    if (half <= kMostStep) {
      step(6 - half);
    } else if (half == kLongFollows) {
      take_long();
    } else if (half != kNothing) {
      fail();
    }
  }
  void take_long() {
    const int next = byte();
    if ((next & 0x80) != 0) {
      step(192 - next);
    } else {
      last_ = static_cast<std::uint16_t>(next << 8 | byte());
      put();
    }
  }
  void step(int difference) {
    last_ = static_cast<std::uint16_t>(last_ + difference);
    put();
  }
  void put() {
    if (written_ >= pixels_.total() || (table_ && last_ >= table_->size())) fail();
    pixels_.ptr<std::uint16_t>()[written_++] = table_ ? (*table_)[last_] : last_;
  }

  std::string_view rest_;
  const std::string& place_;
  std::optional<std::vector<std::uint16_t>> table_;
  cv::Mat1w pixels_;
  std::size_t written_ = 0;
  std::uint16_t last_ = 0;
};

}  // namespace

cv::Mat1w decode_oni_depth(std::string_view bytes,
                           const std::string& codec,
                           cv::Size size,
                           const std::string& place) {
  if (size.empty()) throw Error("{}: the recording does not tell the size of its depth", place);
  if (codec == "NONE") {
    cv::Mat1w pixels(size);
    if (bytes.size() != pixels.total() * 2) throw DamagedImage("{}: damaged depth", place);
    std::memcpy(pixels.data, bytes.data(), bytes.size());
    return pixels;
  }
  if (codec != "16zT" && codec != "16zP") {
    throw Error("{}: depth of codec '{}', expected NONE, 16zT or 16zP", place, codec);
  }
  DifferenceCodes codes(bytes, place);
  if (codec == "16zT") codes.read_table();
  return codes.pixels(size);
}

}  // namespace stillmap
