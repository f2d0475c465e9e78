// SPDX-License-Identifier: Apache-2.0
#include "tooling/ros/ros_topics.hpp"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <string_view>

#include "stillmap/core/ascii_lower.hpp"
#include "stillmap/core/error.hpp"
#include "stillmap/core/joined.hpp"

namespace stillmap {
namespace {

using Topics = std::vector<ImageTopic>;

template <class Fits>
Topics those(const Topics& topics, const Fits& fits) {
  Topics found;
  std::ranges::copy_if(topics, std::back_inserter(found), fits);
  return found;
}

// Those that are preferred, if there are any, else all.
template <class Preferred>
Topics prefer(const Topics& topics, const Preferred& preferred) {
  Topics found = those(topics, preferred);
  return found.empty() ? topics : found;
}

auto of_kind(RosImageKind kind) {
  return [kind](const ImageTopic& topic) { return topic.kind == kind; };
}

auto with_word(std::string_view a, std::string_view b) {
  return [a, b](const ImageTopic& topic) {
    const std::string name = ascii_lower(topic.name);
    return name.find(a) != std::string::npos || name.find(b) != std::string::npos;
  };
}

std::string list_of(const Topics& topics) {
  std::vector<std::string> names;
  for (const ImageTopic& topic : topics) names.push_back(topic.name);
  return names.empty() ? "none" : joined(names, ", ");
}

ImageTopic only(const Topics& found,
                const Topics& all,
                const std::string& kind,
                const std::string& place) {
  if (found.size() == 1) return found.front();
  if (found.empty()) {
    throw Error("{}: no topic with {} images; topics with images: {}", place, kind, list_of(all));
  }
  throw Error("{}: several topics with {} images, name one with --{}-topic: {}",
              place,
              kind,
              kind,
              list_of(found));
}

ImageTopic named(const Topics& topics, const std::string& asked, const std::string& place) {
  const auto found = std::ranges::find(topics, asked, &ImageTopic::name);
  if (found != topics.end()) return *found;
  throw Error("{}: no topic {} with images; topics with images: {}", place, asked, list_of(topics));
}

Topics uncompressed(const Topics& topics) {
  return prefer(topics, [](const ImageTopic& topic) { return topic.type == RosImageType::kPlain; });
}

std::size_t parts_in_common(const std::filesystem::path& a, const std::filesystem::path& b) {
  const auto [end, unused] = std::mismatch(a.begin(), a.end(), b.begin(), b.end());
  return static_cast<std::size_t>(std::distance(a.begin(), end));
}

}  // namespace

ImageTopic choose_color_topic(const Topics& topics,
                              const std::string& asked,
                              const std::string& place) {
  if (!asked.empty()) return named(topics, asked, place);
  Topics found = those(topics, of_kind(RosImageKind::kColor));
  if (found.empty()) found = those(topics, of_kind(RosImageKind::kGray));
  found = uncompressed(found);
  if (found.size() > 1) found = prefer(found, with_word("color", "rgb"));
  return only(found, topics, "color", place);
}

ImageTopic choose_depth_topic(const Topics& topics,
                              const std::string& asked,
                              const std::string& place) {
  if (!asked.empty()) return named(topics, asked, place);
  Topics found = uncompressed(those(topics, of_kind(RosImageKind::kDepth)));
  if (found.size() > 1) found = prefer(found, with_word("aligned", "registered"));
  return only(found, topics, "depth", place);
}

std::string info_topic_of(const std::string& topic, const std::vector<std::string>& info_topics) {
  std::string best;
  std::size_t most = 1;  // all begin with a slash
  for (const std::string& info : info_topics) {
    const std::size_t common = parts_in_common(topic, info);
    if (common == most) best.clear();
    if (common <= most) continue;
    most = common;
    best = info;
  }
  return best.empty() && info_topics.size() == 1 ? info_topics.front() : best;
}

}  // namespace stillmap
