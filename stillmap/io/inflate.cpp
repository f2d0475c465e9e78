// SPDX-License-Identifier: Apache-2.0
#include "stillmap/io/inflate.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <span>

#include <zlib.h>

#include "stillmap/io/huffman_table.hpp"

namespace stillmap {
namespace {

static_assert(std::endian::native == std::endian::little, "bits are taken from the low end");

constexpr std::size_t kMaxExpansion = 1032;  // deflate's: 258 bytes from two bits
constexpr std::size_t kSlack = 16;           // bytes that may be written beyond the target's end
constexpr std::size_t kMaxLitlen = 286, kMaxDistances = 30;

/// The bits of a stream. Past its end come zeros, and `overrun` says so.
class BitSource {
 public:
  explicit BitSource(std::string_view bytes) : rest_(bytes) {}

  /// At least 56 bits, or all there are.
  void refill() {
    if (overrun()) return;
    if (rest_.size() >= 8) {
      std::uint64_t next = 0;
      std::memcpy(&next, rest_.data(), 8);
      bits_ |= next << count_;
      rest_.remove_prefix(static_cast<std::size_t>(63 - count_) / 8);
      count_ |= 56;
      return;
    }
    for (; count_ < 56 && !rest_.empty(); count_ += 8, rest_.remove_prefix(1)) {
      bits_ |= std::uint64_t{static_cast<unsigned char>(rest_.front())} << count_;
    }
  }

  [[nodiscard]] std::uint64_t bits() const { return bits_; }
  [[nodiscard]] bool overrun() const { return count_ < 0; }

  void drop(unsigned count) {
    bits_ >>= count;
    count_ -= static_cast<int>(count);
  }

  [[nodiscard]] std::uint32_t take(unsigned count) {
    const auto value = static_cast<std::uint32_t>(bits_ & ((std::uint64_t{1} << count) - 1));
    drop(count);
    return value;
  }

  /// From the next whole byte on; the bytes that were looked at already are given back.
  [[nodiscard]] std::string_view bytes() {
    if (overrun()) return {};
    const std::size_t ahead = static_cast<std::size_t>(count_) / 8;
    rest_ = {rest_.data() - ahead, rest_.size() + ahead};
    bits_ = 0;
    count_ = 0;
    return rest_;
  }
  void skip_bytes(std::size_t count) { rest_.remove_prefix(count); }

 private:
  std::string_view rest_;
  std::uint64_t bits_ = 0;
  int count_ = 0;  // below 0: more bits were taken than there are
};

HuffmanEntry base(unsigned value, unsigned extra) {
  return {
      HuffmanKind::kBase, 0, static_cast<std::uint8_t>(extra), static_cast<std::uint16_t>(value)};
}

struct Meanings {
  std::array<HuffmanEntry, 288> litlen;
  std::array<HuffmanEntry, 32> distances;
};

// RFC 1951, 3.2.5.
const Meanings& meanings() {
  static const Meanings kMeanings = [] {
    Meanings m;
    for (std::size_t i = 0; i < 256; ++i) {
      m.litlen[i] = {HuffmanKind::kLiterals, 0, 1, static_cast<std::uint16_t>(i)};
    }
    m.litlen[256].kind = HuffmanKind::kEndOfBlock;
    unsigned length = 3;
    for (unsigned i = 0; i < 28; ++i) {
      const unsigned extra = i < 8 ? 0 : i / 4 - 1;
      m.litlen[257 + i] = base(length, extra);
      length += 1U << extra;
    }
    m.litlen[285] = base(258, 0);
    unsigned distance = 1;
    for (unsigned i = 0; i < kMaxDistances; ++i) {
      const unsigned extra = i < 4 ? 0 : i / 2 - 1;
      m.distances[i] = base(distance, extra);
      distance += 1U << extra;
    }
    return m;
  }();
  return kMeanings;
}

class Inflater {
 public:
  Inflater(std::string_view deflated, std::span<std::uint8_t> with_slack)
      : source_(deflated),
        begin_(with_slack.data()),
        out_(with_slack.data()),
        end_(begin_ + with_slack.size() - kSlack) {}

  /// All blocks; true when they are sound and fill the target.
  [[nodiscard]] bool run() {
    for (bool last = false; !last;) {
      source_.refill();
      last = source_.take(1) != 0;
      const std::uint32_t type = source_.take(2);
      const bool good = type == 0   ? copy_stored()
                        : type == 1 ? read_fixed_codes() && decode_block()
                                    : type == 2 && read_codes() && decode_block();
      if (!good || source_.overrun()) return false;
    }
    return out_ == end_;
  }

  /// What follows the blocks.
  [[nodiscard]] std::string_view rest() { return source_.bytes(); }

 private:
  [[nodiscard]] bool copy_stored() {
    const std::string_view bytes = source_.bytes();
    if (bytes.size() < 4) return false;
    const auto byte = [&](std::size_t i) -> std::size_t {
      return static_cast<unsigned char>(bytes[i]);
    };
    const std::size_t size = byte(0) | byte(1) << 8U, inverse = byte(2) | byte(3) << 8U;
    if (size != (~inverse & 0xffffU) || bytes.size() - 4 < size) return false;
    if (size > static_cast<std::size_t>(end_ - out_)) return false;
    std::memcpy(out_, bytes.data() + 4, size);
    out_ += size;
    source_.skip_bytes(4 + size);
    return true;
  }

  [[nodiscard]] bool read_fixed_codes() {
    std::array<std::uint8_t, 288> lengths;
    for (std::size_t i = 0; i < lengths.size(); ++i) {
      lengths[i] = i < 144 ? 8 : i < 256 ? 9 : i < 280 ? 7 : 8;
    }
    std::array<std::uint8_t, 32> distances;
    distances.fill(5);
    return make_tables(lengths, distances);
  }

  // RFC 1951, 3.2.7.
  [[nodiscard]] bool read_codes() {
    const std::size_t litlen = source_.take(5) + 257, distances = source_.take(5) + 1;
    const std::size_t count = source_.take(4) + 4;
    if (litlen > kMaxLitlen || distances > kMaxDistances) return false;
    static constexpr std::array<std::uint8_t, 19> kOrder = {
        16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15};
    std::array<std::uint8_t, 19> own{};
    for (std::size_t i = 0; i < count; ++i) {
      if (i % 8 == 0) source_.refill();
      own[kOrder[i]] = static_cast<std::uint8_t>(source_.take(3));
    }
    std::array<HuffmanEntry, 19> plain;
    for (std::size_t i = 0; i < plain.size(); ++i) plain[i] = base(static_cast<unsigned>(i), 0);
    std::array<std::uint8_t, kMaxLitlen + kMaxDistances> lengths{};
    const std::span all = std::span(lengths).first(litlen + distances);
    return litlen_.build(own, plain) && read_lengths(all) &&
           make_tables(all.first(litlen), all.subspan(litlen));
  }

  // By the code that litlen_ holds for the moment.
  [[nodiscard]] bool read_lengths(std::span<std::uint8_t> lengths) {
    for (std::size_t i = 0; i < lengths.size();) {
      source_.refill();
      const HuffmanEntry& entry = litlen_.first(source_.bits());
      if (entry.kind != HuffmanKind::kBase || source_.overrun()) return false;
      source_.drop(entry.bits);
      if (entry.value < 16) {
        lengths[i++] = static_cast<std::uint8_t>(entry.value);
        continue;
      }
      if (entry.value == 16 && i == 0) return false;
      const std::uint8_t value = entry.value == 16 ? lengths[i - 1] : std::uint8_t{0};
      const std::size_t times = entry.value == 16   ? 3 + source_.take(2)
                                : entry.value == 17 ? 3 + source_.take(3)
                                                    : 11 + source_.take(7);
      if (times > lengths.size() - i) return false;
      std::fill_n(lengths.begin() + static_cast<std::ptrdiff_t>(i), times, value);
      i += times;
    }
    return true;
  }

  [[nodiscard]] bool make_tables(std::span<const std::uint8_t> litlen,
                                 std::span<const std::uint8_t> distances) {
    if (!litlen_.build(litlen, meanings().litlen)) return false;
    litlen_.pair_literals();
    return distances_.build(distances, meanings().distances);
  }

  [[nodiscard]] bool decode_block() {
    BitSource source = source_;  // a copy, for the compiler to keep in registers
    std::uint8_t* out = out_;
    for (;;) {
      source.refill();
      if (source.overrun() || out > end_) return false;
      // 56 bits are good for four steps of 11 and a look at the next.
      HuffmanEntry entry = litlen_.first(source.bits());
      for (int step = 0; step < 4 && entry.kind == HuffmanKind::kLiterals; ++step) {
        std::memcpy(out, &entry.value, 2);
        out += entry.extra;
        source.drop(entry.bits);
        entry = litlen_.first(source.bits());
      }
      if (entry.kind == HuffmanKind::kLiterals) continue;
      source.refill();
      if (entry.kind == HuffmanKind::kLongCode) entry = litlen_.second(entry, source.bits());
      source.drop(entry.bits);
      if (entry.kind == HuffmanKind::kLiterals) {
        *out++ = static_cast<std::uint8_t>(entry.value);
        continue;
      }
      if (entry.kind == HuffmanKind::kEndOfBlock) break;
      if (entry.kind != HuffmanKind::kBase) return false;
      const std::size_t length = entry.value + source.take(entry.extra);
      HuffmanEntry far = distances_.first(source.bits());
      if (far.kind == HuffmanKind::kLongCode) far = distances_.second(far, source.bits());
      if (far.kind != HuffmanKind::kBase) return false;
      source.drop(far.bits);
      const std::size_t distance = far.value + source.take(far.extra);
      if (out > end_ || length > static_cast<std::size_t>(end_ - out)) return false;
      if (distance > static_cast<std::size_t>(out - begin_)) return false;
      repeat(out, distance, length);
      out += length;
    }
    source_ = source;
    out_ = out;
    return out_ <= end_;
  }

  // Eight at a time where they do not overlap, and so up to seven too many, into the slack or what
  // is yet to be written.
  static void repeat(std::uint8_t* out, std::size_t distance, std::size_t length) {
    const std::uint8_t* from = out - distance;
    if (distance == 1) {
      std::memset(out, *from, length);
    } else if (distance >= 8) {
      for (std::size_t i = 0; i < length; i += 8) std::memcpy(out + i, from + i, 8);
    } else {
      for (std::size_t i = 0; i < length; ++i) out[i] = from[i];
    }
  }

  BitSource source_;
  const std::uint8_t* begin_;
  std::uint8_t* out_;
  const std::uint8_t* end_;  // of the target, without the slack
  HuffmanTable litlen_, distances_;
};

std::uint32_t big_endian(std::string_view bytes) {
  std::uint32_t value = 0;
  for (const char c : bytes.substr(0, 4)) value = value << 8U | static_cast<unsigned char>(c);
  return value;
}

// RFC 1950: deflate, no preset dictionary, and a checksum of these.
bool good_header(std::string_view stream) {
  if (stream.size() < 6) return false;
  const auto method = static_cast<unsigned char>(stream[0]);
  const auto flags = static_cast<unsigned char>(stream[1]);
  return (method & 0x0fU) == 8 && (method >> 4U) <= 7 && (flags & 0x20U) == 0 &&
         (method * 256U + flags) % 31 == 0;
}

}  // namespace

std::optional<std::vector<std::uint8_t>> inflate_whole(std::string_view stream, std::size_t size) {
  if (!good_header(stream) || size / kMaxExpansion > stream.size()) return std::nullopt;
  std::vector<std::uint8_t> bytes(size + kSlack);
  Inflater inflater(stream.substr(2), bytes);
  if (!inflater.run()) return std::nullopt;
  const std::string_view checksum = inflater.rest();
  if (checksum.size() != 4) return std::nullopt;
  bytes.resize(size);
  if (adler32_z(1, bytes.data(), size) != big_endian(checksum)) return std::nullopt;
  return bytes;
}

}  // namespace stillmap
