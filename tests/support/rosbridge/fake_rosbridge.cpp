// SPDX-License-Identifier: Apache-2.0
#include "tests/support/rosbridge/fake_rosbridge.hpp"

#include <cmath>
#include <deque>
#include <map>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <fcntl.h>

namespace stillmap {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
using asio::ip::tcp;
using boost::system::error_code;
using nlohmann::json;

std::uint64_t nanoseconds(double seconds) {
  return static_cast<std::uint64_t>(std::llround(seconds * 1e6)) * 1000U;
}

}  // namespace

class FakeRosbridge::Serving {
 public:
  Serving(BridgeCoding coding, Rosapi rosapi) : coding_(coding), rosapi_(rosapi) {
    listen(tcp::endpoint(asio::ip::address_v4::loopback(), 0));
    thread_ = std::thread([this] { context_.run(); });
  }
  ~Serving() {
    context_.stop();
    thread_.join();
  }
  Serving(const Serving&) = delete;
  Serving& operator=(const Serving&) = delete;

  // For any thread.
  template <class Call>
  void post(Call call) {
    asio::post(context_, std::move(call));
  }
  [[nodiscard]] std::uint16_t port() const { return place_.port(); }

  // For the server's thread.
  struct Topic {
    std::string name, type;
    json sample;
  };
  std::vector<Topic> topics;

  void publish(const std::string& topic, const json& content) {
    const auto subscribed = subscribed_.find(topic);
    if (subscribed == subscribed_.end()) {
      waiting_.emplace_back(topic, content);
      return;
    }
    send(published(topic, content), subscribed->second);
  }

  void send_bytes(std::string bytes, bool binary) {
    if (subscribed_.empty()) {
      waiting_bytes_.emplace_back(std::move(bytes), binary);
    } else if (client_) {
      client_->send(std::move(bytes), binary);
    }
  }

  void go_down() {
    error_code ignored;
    acceptor_->close(ignored);
    if (client_) client_->close();
    client_.reset();
    subscribed_.clear();
  }
  void come_up() { listen(place_); }

 private:
  class Client : public std::enable_shared_from_this<Client> {
   public:
    Client(tcp::socket socket, Serving& serving) : socket_(std::move(socket)), serving_(serving) {}

    void begin() {
      socket_.auto_fragment(false);
      socket_.async_accept([self = shared_from_this()](error_code error) {
        if (!error) self->read();
      });
    }
    void send(std::string bytes, bool binary) {
      queue_.emplace_back(std::move(bytes), binary);
      if (queue_.size() == 1) write();
    }
    void close() { beast::get_lowest_layer(socket_).close(); }

   private:
    void read() {
      socket_.async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t) {
        if (error) return;
        const json message = json::parse(beast::buffers_to_string(self->buffer_.cdata()));
        self->buffer_.clear();
        self->serving_.hear(message);
        self->read();
      });
    }
    void write() {
      socket_.binary(queue_.front().second);
      socket_.async_write(asio::buffer(queue_.front().first),
                          [self = shared_from_this()](error_code error, std::size_t) {
                            if (error) return;
                            self->queue_.pop_front();
                            if (!self->queue_.empty()) self->write();
                          });
    }

    beast::websocket::stream<beast::tcp_stream> socket_;
    Serving& serving_;
    beast::flat_buffer buffer_;
    std::deque<std::pair<std::string, bool>> queue_;
  };

  void listen(const tcp::endpoint& place) {
    acceptor_.emplace(context_, place);
    ::fcntl(acceptor_->native_handle(), F_SETFD, FD_CLOEXEC);  // tests start programs
    place_ = acceptor_->local_endpoint();
    accept();
  }

  void accept() {
    acceptor_->async_accept([this](error_code error, tcp::socket socket) {
      if (error) return;
      subscribed_.clear();
      client_ = std::make_shared<Client>(std::move(socket), *this);
      client_->begin();
      accept();
    });
  }

  void hear(const json& message) {
    const std::string op = message.at("op");
    if (op == "call_service") answer(message);
    if (op == "unsubscribe") subscribed_.erase(message.at("topic"));
    if (op != "subscribe") return;
    const std::string topic = message.at("topic");
    const bool cbor = message.at("compression") == "cbor";
    if (message.at("throttle_rate") > 0) {
      for (const Topic& listed : topics) {
        if (listed.name == topic && !listed.sample.is_null()) {
          send(published(topic, listed.sample), cbor);
        }
      }
      return;
    }
    subscribed_[topic] = cbor;
    send_waiting();
  }

  void answer(const json& message) {
    json values = {{"topics", json::array()}, {"types", json::array()}};
    for (const Topic& topic : topics) {
      values["topics"].push_back(topic.name);
      values["types"].push_back(topic.type);
    }
    const bool good = rosapi_ == Rosapi::kAnswers && message.at("service") == "/rosapi/topics";
    send({{"op", "service_response"},
          {"id", message.at("id")},
          {"service", message.at("service")},
          {"values", good ? values : json("Service /rosapi/topics does not exist")},
          {"result", good}},
         false);
  }

  void send_waiting() {
    for (auto& [bytes, binary] : std::exchange(waiting_bytes_, {})) {
      send_bytes(std::move(bytes), binary);
    }
    for (const auto& [topic, content] : std::exchange(waiting_, {})) publish(topic, content);
  }

  void send(json message, bool cbor) {
    const BridgeCoding coding = cbor ? coding_ : BridgeCoding::kJson;
    if (coding == BridgeCoding::kJson && message.contains("msg")) {
      json& content = message["msg"];
      if (content.contains("data") && content["data"].is_binary()) {
        const auto& bytes = content["data"].get_binary();
        content["data"] = to_base64({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
      }
    }
    if (client_) client_->send(encoded(message, coding), coding == BridgeCoding::kCbor);
  }

  BridgeCoding coding_;
  Rosapi rosapi_;
  asio::io_context context_{1};
  asio::executor_work_guard<asio::io_context::executor_type> busy_{context_.get_executor()};
  std::optional<tcp::acceptor> acceptor_;
  tcp::endpoint place_;
  std::shared_ptr<Client> client_;
  std::map<std::string, bool> subscribed_;  // whether in CBOR
  std::deque<std::pair<std::string, json>> waiting_;
  std::deque<std::pair<std::string, bool>> waiting_bytes_;
  std::thread thread_;
};

FakeRosbridge::FakeRosbridge(BridgeCoding coding, Rosapi rosapi)
    : serving_(std::make_unique<Serving>(coding, rosapi)) {}

FakeRosbridge::~FakeRosbridge() = default;

std::string FakeRosbridge::url() const {
  return "ws://127.0.0.1:" + std::to_string(serving_->port());
}

void FakeRosbridge::add_topic(const std::string& name, const std::string& type, json sample) {
  serving_->post([this, topic = Serving::Topic{name, type, std::move(sample)}] {
    serving_->topics.push_back(topic);
  });
}

void FakeRosbridge::publish(const std::string& topic, json content) {
  serving_->post(
      [this, topic, content = std::move(content)] { serving_->publish(topic, content); });
}

void FakeRosbridge::send_bytes(std::string bytes, bool binary) {
  serving_->post([this, bytes = std::move(bytes), binary] { serving_->send_bytes(bytes, binary); });
}

void FakeRosbridge::go_down() {
  serving_->post([this] { serving_->go_down(); });
}

void FakeRosbridge::come_up() {
  serving_->post([this] { serving_->come_up(); });
}

namespace {

json color_value(const Sequence& sequence, std::uint32_t frame) {
  const FramePtr read = sequence.read(FrameId(frame));
  return image_value(
      read->color.mat, "rgb8", nanoseconds(read->stamp.seconds), BridgeCoding::kCbor);
}

// In millimetres, as ROS has it.
json depth_value(const Sequence& sequence, std::uint32_t frame) {
  const FramePtr read = sequence.read(FrameId(frame));
  cv::Mat1w millimetres;
  read->depth.mat.convertTo(millimetres, CV_16U, 1000);
  return image_value(millimetres, "16UC1", nanoseconds(read->stamp.seconds), BridgeCoding::kCbor);
}

}  // namespace

void FakeRosbridge::add_camera(const Sequence& sequence) {
  const json info = info_value(sequence.camera());
  add_topic(kColorTopic, "sensor_msgs/Image", color_value(sequence, 0));
  add_topic(kDepthTopic, "sensor_msgs/Image", depth_value(sequence, 0));
  add_topic("/camera/color/camera_info", "sensor_msgs/CameraInfo", info);
  add_topic("/camera/aligned_depth_to_color/camera_info", "sensor_msgs/CameraInfo", info);
}

void FakeRosbridge::publish_frame(const Sequence& sequence, std::uint32_t frame) {
  publish(kColorTopic, color_value(sequence, frame));
  publish(kDepthTopic, depth_value(sequence, frame));
}

}  // namespace stillmap
