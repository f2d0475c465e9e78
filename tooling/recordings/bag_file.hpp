// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace stillmap {

/// A topic of a bag with the number of its messages.
struct BagTopic {
  std::string name;
  std::string type;  ///< such as "sensor_msgs/Image"
  std::size_t messages = 0;
};

/// Whether this build has the library of bags.
[[nodiscard]] bool has_bag_library();

/// A bag of ROS 1, open for reading by one thread at a time.
class BagFile {
 public:
  /// Lists the topics with messages of the `types`. Throws Error for a file that is no readable
  /// bag, and in a build without the library.
  BagFile(const std::filesystem::path& path, const std::vector<std::string>& types);
  BagFile(const BagFile&) = delete;
  BagFile& operator=(const BagFile&) = delete;
  ~BagFile();

  [[nodiscard]] const std::vector<BagTopic>& topics() const { return topics_; }

  /// The bytes of a message; messages of a topic are in the order in which they were recorded.
  /// Throws Error for a damaged part of the bag.
  [[nodiscard]] std::string read(std::size_t topic, std::size_t message) const;

 private:
  class Library;
  std::vector<BagTopic> topics_;
  std::unique_ptr<Library> library_;
};

}  // namespace stillmap
