// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <nlohmann/json.hpp>

#include "stillmap/sensor/sequence.hpp"
#include "tests/support/bridge_messages.hpp"

namespace stillmap {

/// A robot with rosbridge on loopback, on a thread of its own, for one client at a time. What a
/// test publishes waits until somebody has subscribed to its topic.
class FakeRosbridge {
 public:
  enum class Rosapi { kAnswers, kRefuses };
  /// `coding`: of topics that are asked for in CBOR; a server may ignore the wish.
  explicit FakeRosbridge(BridgeCoding coding, Rosapi rosapi = Rosapi::kAnswers);
  FakeRosbridge(const FakeRosbridge&) = delete;
  FakeRosbridge& operator=(const FakeRosbridge&) = delete;
  ~FakeRosbridge();

  [[nodiscard]] std::string url() const;

  /// Lists a topic. Who asks for one message of it gets the sample, whose bytes are binary; null:
  /// nothing.
  void add_topic(const std::string& name, const std::string& type, nlohmann::json sample);
  /// The topics of an RGB-D camera, with the first frame of a sequence as their samples.
  void add_camera(const Sequence& sequence);

  void publish(const std::string& topic, nlohmann::json content);
  /// The colour and depth images of a frame.
  void publish_frame(const Sequence& sequence, std::uint32_t frame);
  /// Sends bytes as they are, once somebody has subscribed to something.
  void send_bytes(std::string bytes, bool binary);

  /// Closes the connection, and refuses others until come_up().
  void go_down();
  void come_up();

  static constexpr const char* kColorTopic = "/camera/color/image_raw";
  static constexpr const char* kDepthTopic = "/camera/aligned_depth_to_color/image_raw";

 private:
  class Serving;
  std::unique_ptr<Serving> serving_;
};

}  // namespace stillmap
