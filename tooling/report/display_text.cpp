// SPDX-License-Identifier: Apache-2.0
#include "tooling/report/display_text.hpp"

#include <cmath>

#include <fmt/core.h>

namespace stillmap {
namespace {

std::string with_unit(double value, const char* unit) {
  const double size = std::abs(value);
  const int decimals = size >= 99.95 ? 0 : size >= 9.995 ? 1 : 2;
  return fmt::format("{:.{}f}\u00A0{}", value, decimals, unit);
}

}  // namespace

std::string length_text(double metres) {
  if (!std::isfinite(metres)) return kDash;
  if (std::abs(metres) < 0.01) return with_unit(metres * 1000, "mm");
  return std::abs(metres) < 1 ? with_unit(metres * 100, "cm") : with_unit(metres, "m");
}

std::string duration_text(double milliseconds) {
  if (!std::isfinite(milliseconds)) return kDash;
  return milliseconds < 1000 ? with_unit(milliseconds, "ms") : with_unit(milliseconds / 1000, "s");
}

std::string memory_text(double megabytes) {
  if (!std::isfinite(megabytes)) return kDash;
  return megabytes < 1000 ? fmt::format("{:.0f}\u00A0MB", megabytes)
                          : with_unit(megabytes / 1000, "GB");
}

std::string count_text(std::size_t count) {
  const std::string digits = std::to_string(count);
  std::string text;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) text += ',';
    text += digits[i];
  }
  return text;
}

std::string share_text(std::size_t part, std::size_t whole) {
  if (whole == 0) return kDash;
  if (part >= whole) return "100\u00A0%";
  const double percent = 100.0 * static_cast<double>(part) / static_cast<double>(whole);
  return fmt::format("{:.1f}\u00A0%", std::floor(percent * 10) / 10);
}

}  // namespace stillmap
