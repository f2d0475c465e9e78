// SPDX-License-Identifier: Apache-2.0
#include "tooling/recordings/bag_file.hpp"

#include "stillmap/core/error.hpp"

#if STILLMAP_WITH_ROSBAG
#include <algorithm>
#include <cstdint>

#include <rosbag/bag.h>
#include <rosbag/view.h>
#endif

namespace stillmap {

#if STILLMAP_WITH_ROSBAG

namespace {

// The library's exceptions as an Error of one line.
template <class Call>
auto with_errors_of(const std::filesystem::path& path, const Call& call) {
  try {
    return call();
  } catch (const rosbag::BagUnindexedException&) {
    throw Error("{}: the bag has no index, its recording was cut off; `rosbag reindex` makes one",
                path.string());
  } catch (const std::exception& exception) {
    std::string text = exception.what();
    std::ranges::replace_if(
        text, [](char c) { return c < ' ' || c > '~'; }, ' ');
    throw Error("{}: no readable bag: {}", path.string(), text.substr(0, 200));
  }
}

}  // namespace

class BagFile::Library {
 public:
  explicit Library(const std::filesystem::path& path) : path_(path), bag_(path.string()) {}

  // The topics in the order of their first messages.
  [[nodiscard]] std::vector<BagTopic> list(const std::vector<std::string>& types) {
    std::vector<BagTopic> topics;
    rosbag::View view(bag_, rosbag::TypeQuery(types));
    for (const rosbag::MessageInstance& message : view) {
      const auto found = std::ranges::find(topics, message.getTopic(), &BagTopic::name);
      const auto topic = static_cast<std::size_t>(found - topics.begin());
      if (found == topics.end()) {
        topics.push_back({message.getTopic(), message.getDataType(), 0});
        messages_.emplace_back();
      }
      messages_[topic].push_back(message);
      ++topics[topic].messages;
    }
    return topics;
  }

  [[nodiscard]] std::string read(std::size_t topic, std::size_t index) const {
    return with_errors_of(path_, [&] {
      const rosbag::MessageInstance& message = messages_.at(topic).at(index);
      std::string bytes(message.size(), '\0');
      ros::serialization::OStream stream(reinterpret_cast<std::uint8_t*>(bytes.data()),
                                         static_cast<std::uint32_t>(bytes.size()));
      message.write(stream);
      return bytes;
    });
  }

 private:
  std::filesystem::path path_;
  rosbag::Bag bag_;
  std::vector<std::vector<rosbag::MessageInstance>> messages_;  // by topic
};

bool has_bag_library() {
  return true;
}

BagFile::BagFile(const std::filesystem::path& path, const std::vector<std::string>& types) {
  with_errors_of(path, [&] {
    library_ = std::make_unique<Library>(path);
    topics_ = library_->list(types);
  });
}

std::string BagFile::read(std::size_t topic, std::size_t message) const {
  return library_->read(topic, message);
}

#else

class BagFile::Library {};

bool has_bag_library() {
  return false;
}

BagFile::BagFile(const std::filesystem::path& path, const std::vector<std::string>&) {
  throw Error("{}: this build cannot read bags; install librosbag-storage-dev and build again",
              path.string());
}

std::string BagFile::read(std::size_t, std::size_t) const {
  return {};
}

#endif

BagFile::~BagFile() = default;

}  // namespace stillmap
