// SPDX-License-Identifier: Apache-2.0
#include "tooling/ros/cbor.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "stillmap/io/image_io.hpp"

namespace stillmap {
namespace {

using nlohmann::json;

// The kinds of items, the upper three bits of their first byte.
enum class Major : std::uint8_t {
  kUnsigned = 0,
  kNegative = 1,
  kBytes = 2,
  kText = 3,
  kArray = 4,
  kMap = 5,
  kTag = 6,
  kSimple = 7
};

double from_half(std::uint16_t bits) {
  const int exponent = (bits >> 10U) & 0x1F;
  const int mantissa = bits & 0x3FF;
  double value = 0;
  if (exponent == 0) {
    value = std::ldexp(mantissa, -24);
  } else if (exponent == 31) {
    value = mantissa == 0 ? std::numeric_limits<double>::infinity()
                          : std::numeric_limits<double>::quiet_NaN();
  } else {
    value = std::ldexp(mantissa + 1024, exponent - 25);
  }
  return (bits & 0x8000U) != 0 ? -value : value;
}

class Reader {
 public:
  Reader(std::string_view bytes, const std::string& place) : rest_(bytes), place_(place) {}

  [[nodiscard]] json whole() {
    json value = item(0);
    if (!rest_.empty()) fail("bytes after its end");
    return value;
  }

 private:
  struct Head {
    Major major{};
    std::uint8_t low = 0;        // the lower five bits
    std::uint64_t argument = 0;  // a value, a size or a tag
  };

  [[noreturn]] void fail(const char* what) const {
    throw DamagedImage("{}: damaged CBOR: {}", place_, what);
  }

  [[nodiscard]] std::string_view take(std::uint64_t count) {
    if (count > rest_.size()) fail("it ends too early");
    const std::string_view taken = rest_.substr(0, static_cast<std::size_t>(count));
    rest_.remove_prefix(taken.size());
    return taken;
  }

  [[nodiscard]] std::uint64_t number(std::size_t size) {
    std::uint64_t value = 0;
    for (const char byte : take(size)) value = value << 8U | static_cast<std::uint8_t>(byte);
    return value;
  }

  [[nodiscard]] Head head() {
    const auto first = static_cast<std::uint8_t>(number(1));
    Head head{static_cast<Major>(first >> 5U), static_cast<std::uint8_t>(first & 0x1FU), 0};
    if (head.low < 24) {
      head.argument = head.low;
    } else if (head.low < 28) {
      head.argument = number(std::size_t{1} << (head.low - 24U));
    } else {
      fail("an item of unknown length");
    }
    return head;
  }

  [[nodiscard]] json item(int depth) {
    if (depth > kMaxValueDepth) fail("values lie too deep in each other");
    if (++values_ > kMaxValues) fail("too many values");
    std::optional<std::uint64_t> tag;
    Head head = this->head();
    for (; head.major == Major::kTag; head = this->head()) tag = head.argument;
    switch (head.major) {
      case Major::kUnsigned:
        return head.argument;
      case Major::kNegative:
        if (head.argument > std::uint64_t{std::numeric_limits<std::int64_t>::max()}) {
          fail("a number beyond 64 bits");
        }
        return -1 - static_cast<std::int64_t>(head.argument);
      case Major::kBytes:
        return byte_string(head.argument, tag);
      case Major::kText:
        return text(head.argument);
      case Major::kArray:
        return array(head.argument, depth);
      case Major::kMap:
        return map(head.argument, depth);
      case Major::kTag:
      case Major::kSimple:
        break;
    }
    return simple(head);
  }

  [[nodiscard]] json byte_string(std::uint64_t size, std::optional<std::uint64_t> tag) {
    const std::string_view bytes = take(size);
    json::binary_t::container_type copied(bytes.begin(), bytes.end());
    return tag ? json::binary(std::move(copied), *tag) : json::binary(std::move(copied));
  }

  [[nodiscard]] std::string text(std::uint64_t size) {
    std::string text(take(size));
    try {
      (void)json(text).dump();
    } catch (const json::exception&) {
      fail("a text that is no UTF-8");
    }
    return text;
  }

  [[nodiscard]] json array(std::uint64_t size, int depth) {
    json values = json::array();
    for (std::uint64_t i = 0; i < size; ++i) values.push_back(item(depth + 1));
    return values;
  }

  [[nodiscard]] json map(std::uint64_t size, int depth) {
    json values = json::object();
    for (std::uint64_t i = 0; i < size; ++i) {
      const Head key = head();
      if (key.major != Major::kText) fail("a key that is no text");
      std::string name = text(key.argument);
      values[std::move(name)] = item(depth + 1);
    }
    return values;
  }

  [[nodiscard]] json simple(const Head& head) {
    constexpr std::uint8_t kFalse = 20, kTrue = 21, kNull = 22, kUndefined = 23;
    switch (head.low) {
      case kFalse:
      case kTrue:
        return head.low == kTrue;
      case kNull:
      case kUndefined:
        return nullptr;
      case 25:
        return from_half(static_cast<std::uint16_t>(head.argument));
      case 26:
        return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(head.argument)));
      case 27:
        return std::bit_cast<double>(head.argument);
      default:
        fail("an unknown simple value");
    }
  }

  std::string_view rest_;
  const std::string& place_;
  std::size_t values_ = 0;
};

}  // namespace

json read_cbor(std::string_view bytes, const std::string& place) {
  return Reader(bytes, place).whole();
}

}  // namespace stillmap
