// SPDX-License-Identifier: Apache-2.0
#include "tooling/pipeline/object_watch.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "stillmap/core/joined.hpp"

namespace stillmap {
namespace {

constexpr double kEarlySeconds = 5;
constexpr std::size_t kMostUnknown = 1000;  // a hostile list of detections may have any number

constexpr std::string_view kAdvice =
    "if people are in the images, the network or its class names do not fit";

}  // namespace

ObjectWatch::ObjectWatch(const CategoryConfig& categories, Warn warn)
    : categories_(categories), warn_(std::move(warn)) {}

void ObjectWatch::on_frame(const RgbdFrame& /*frame*/, const FrameResult& result) {
  if (frames_++ == 0) start_s_ = result.stamp.seconds;
  const double since_start_s = result.stamp.seconds - start_s_;
  for (const ObjectState& object : result.objects) {
    const bool dynamic = object.category == Category::kDynamic;
    if (dynamic && !first_dynamic_s_) first_dynamic_s_ = since_start_s;
    if (!categories_.knows(object.class_name) && unknown_.size() < kMostUnknown) {
      unknown_.insert(object.class_name);
    }
  }
  if (first_dynamic_s_ || warned_early_ || since_start_s < kEarlySeconds) return;
  warned_early_ = true;
  warn_(
      fmt::format("no object of a dynamic class, such as a person, was found in the first {} s: {}",
                  kEarlySeconds,
                  kAdvice));
}

void ObjectWatch::on_end(const RunResult& /*result*/) {
  if (!first_dynamic_s_ && frames_ > 0) {
    warn_(fmt::format(
        "no object of a dynamic class, such as a person, was found in any of {} frames: {}",
        frames_,
        kAdvice));
  }
  if (!unknown_.empty()) warn_(unknown_classes_warning(unknown_));
}

std::string unknown_classes_warning(const std::set<std::string>& names) {
  constexpr std::size_t kMostNamed = 10;
  const auto named = static_cast<std::ptrdiff_t>(std::min(names.size(), kMostNamed));
  const std::vector<std::string> first(names.begin(), std::next(names.begin(), named));
  const std::size_t more = names.size() - first.size();
  return fmt::format(
      "classes that no category knows are taken for static: {}{}; "
      "dynamics.categories.synonyms says what they are",
      joined(first, ", "),
      more > 0 ? fmt::format(" and {} more", more) : "");
}

}  // namespace stillmap
