// SPDX-License-Identifier: Apache-2.0
#include "stillmap/sensor/stamps.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include <fmt/core.h>

#include "stillmap/io/stamp_text.hpp"

namespace stillmap {
namespace {

constexpr std::string_view kDigits = "0123456789";

// "scene-7_0123.25.png" -> "0123.25"; empty where there is no digit.
std::string_view last_number(std::string_view stem) {
  const std::size_t last = stem.find_last_of(kDigits);
  if (last == std::string_view::npos) return {};
  stem = stem.substr(0, last + 1);
  const auto digits_from = [&](std::string_view text) {
    return text.find_last_not_of(kDigits) + 1;
  };
  std::size_t begin = digits_from(stem);
  if (begin >= 2 && stem[begin - 1] == '.' &&
      kDigits.find(stem[begin - 2]) != std::string_view::npos) {
    begin = digits_from(stem.substr(0, begin - 1));
  }
  return stem.substr(begin);
}

}  // namespace

UnitStamps in_seconds(std::vector<Stamp> stamps, const ReadingOptions& options) {
  const StampUnit unit = options.stamp_unit ? *options.stamp_unit : guess_stamp_unit(stamps);
  const double scale = seconds_per(unit, options.rate_hz);
  for (Stamp& stamp : stamps) stamp.seconds *= scale;
  return {std::move(stamps), unit};
}

Remarks unit_remark(const std::string& list, StampUnit unit, const ReadingOptions& options) {
  if (unit == StampUnit::kSeconds) return {};
  const std::string rate =
      unit == StampUnit::kFrames ? fmt::format(", at {} Hz", options.rate_hz) : "";
  return {{fmt::format("{}: stamps are {}{}", list, stamp_unit_words(unit), rate)}, {}};
}

Stamp stamp_of_seconds(double seconds) {
  return {seconds, fmt::format("{:.6f}", seconds)};
}

std::optional<std::vector<Stamp>> numbers_in_names(std::span<const std::filesystem::path> files) {
  std::vector<Stamp> numbers;
  numbers.reserve(files.size());
  for (const std::filesystem::path& file : files) {
    const std::string stem = file.stem().string();
    std::optional<Stamp> number = parse_stamp(last_number(stem));
    if (!number) return std::nullopt;
    numbers.push_back(*std::move(number));
  }
  return numbers;
}

ReadingOptions with_unit_of_names(std::span<const Stamp> numbers, const ReadingOptions& options) {
  if (options.stamp_unit || numbers.empty()) return options;
  constexpr double kClock = 9e8;  // today's, in seconds
  const StampUnit guessed = guess_stamp_unit(numbers);
  const bool whole = std::ranges::all_of(
      numbers, [](const Stamp& number) { return number.text.find('.') == std::string::npos; });
  const bool small = std::ranges::max(numbers, {}, &Stamp::seconds).seconds < kClock;
  const bool short_step = guessed == StampUnit::kSeconds || guessed == StampUnit::kMilliseconds;
  ReadingOptions fixed = options;
  fixed.stamp_unit = whole && small && short_step ? StampUnit::kFrames : guessed;
  return fixed;
}

}  // namespace stillmap
