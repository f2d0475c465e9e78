// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tooling/ros/ros_image.hpp"

namespace stillmap {

/// A topic with images.
struct ImageTopic {
  std::string name;
  RosImageType type = RosImageType::kPlain;
  RosImageKind kind = RosImageKind::kOther;
};

/// The topic of the name `asked`; where that is empty, the only one with colour. Of several, one of
/// the same images uncompressed is preferred, then one with "color" or "rgb" in its name; gray
/// images count where there is no colour. Throws Error, beginning with `place` and listing the
/// topics, where none or several remain.
[[nodiscard]] ImageTopic choose_color_topic(const std::vector<ImageTopic>& topics,
                                            const std::string& asked,
                                            const std::string& place);

/// The same for depth; of several, one with "aligned" or "registered" in its name is preferred.
[[nodiscard]] ImageTopic choose_depth_topic(const std::vector<ImageTopic>& topics,
                                            const std::string& asked,
                                            const std::string& place);

/// Of the topics with camera infos, the one that belongs to the images of `topic`: the one with
/// most parts of its name in common. Empty where there is none, or where several have as many.
[[nodiscard]] std::string info_topic_of(const std::string& topic,
                                        const std::vector<std::string>& info_topics);

}  // namespace stillmap
