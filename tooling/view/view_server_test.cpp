// SPDX-License-Identifier: Apache-2.0
// The server, asked over plain sockets.
#include "tooling/view/view_server.hpp"

#include <string>

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

struct Place {
  std::string host, path;
  int port = 0;
};

Place place_of(const std::string& url) {
  const std::size_t colon = url.rfind(':'), slash = url.find('/', colon);
  return {url.substr(7, colon - 7), url.substr(slash), std::stoi(url.substr(colon + 1))};
}

int connected_socket(const Place& place) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(place.port));
  EXPECT_EQ(inet_pton(AF_INET, place.host.c_str(), &address.sin_addr), 1);
  const int fd = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  EXPECT_EQ(connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
  return fd;
}

void send_text(int fd, const std::string& text) {
  EXPECT_EQ(send(fd, text.data(), text.size(), MSG_NOSIGNAL), static_cast<ssize_t>(text.size()));
}

// What the server answers to a request until it closes the connection.
std::string answer_to(const Place& place, const std::string& request) {
  const int fd = connected_socket(place);
  send_text(fd, request);
  std::string answer;
  std::array<char, 4096> part{};
  for (ssize_t size = 0; (size = recv(fd, part.data(), part.size(), 0)) > 0;) {
    answer.append(part.data(), static_cast<std::size_t>(size));
  }
  close(fd);
  return answer;
}

std::string get(const Place& place, const std::string& path) {
  return answer_to(place, "GET " + path + " HTTP/1.1\r\nHost: x\r\n\r\n");
}

class ServerForPages : public testing::Test {
 protected:
  void SetUp() override {
    if (!viewer_lacks().empty()) GTEST_SKIP() << "built without the viewer: no " << viewer_lacks();
    server_ = std::make_unique<ViewServer>(ViewAddress{},
                                           ViewStart{.title = "x", .frames = {}, .camera = {}});
    place_ = place_of(server_->url());
  }
  std::unique_ptr<ViewServer> server_;
  Place place_;
};

TEST_F(ServerForPages, IsOnLoopbackWithARandomToken) {
  EXPECT_EQ(place_.host, "127.0.0.1");
  EXPECT_THAT(place_.path, testing::MatchesRegex("/[0-9a-f]{32}/"));
}

TEST_F(ServerForPages, GivesThePageAndItsFiles) {
  const std::string page = get(place_, place_.path);
  EXPECT_THAT(page, StartsWith("HTTP/1.1 200 OK"));
  EXPECT_THAT(page, HasSubstr("Content-Security-Policy: default-src 'self'"));
  EXPECT_THAT(page, HasSubstr("<script src=\"three.min.js\""));
  std::size_t bytes = 0;
  for (const char* name : {"",
                           "viewer.css",
                           "three.min.js",
                           "OrbitControls.js",
                           "main.js",
                           "cameras.js",
                           "objects.js",
                           "panel.js",
                           "picture.js",
                           "points.js",
                           "records.js",
                           "scene.js",
                           "socket.js"}) {
    const std::string file = get(place_, place_.path + name);
    EXPECT_THAT(file.substr(0, 15), StartsWith("HTTP/1.1 200 OK")) << name;
    bytes += file.size();
  }
  EXPECT_LT(bytes, 1'500'000U);
  EXPECT_THAT(get(place_, place_.path + "other"), StartsWith("HTTP/1.1 404"));
}

TEST_F(ServerForPages, RefusesWhatLacksTheToken) {
  const std::string token = place_.path.substr(1, 32);
  std::string other = token;
  other.back() = other.back() == '0' ? '1' : '0';
  for (const std::string& path : {std::string("/"),
                                  std::string("/main.js"),
                                  "/" + other + "/",
                                  "/" + token,
                                  "/" + token.substr(1) + "/",
                                  "/" + token + "x/",
                                  "/x/../" + token + "/"}) {
    EXPECT_THAT(get(place_, path), StartsWith("HTTP/1.1 403")) << path;
  }
  EXPECT_THAT(
      answer_to(
          place_,
          "GET /" + other +
              "/socket HTTP/1.1\r\nHost: x\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
              "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n"),
      StartsWith("HTTP/1.1 403"));
}

TEST_F(ServerForPages, SurvivesOtherRequests) {
  EXPECT_THAT(
      answer_to(place_,
                "POST " + place_.path + " HTTP/1.1\r\nHost: x\r\nContent-Length: 0\r\n\r\n"),
      StartsWith("HTTP/1.1 405"));
  EXPECT_EQ(answer_to(place_, "nonsense\r\n\r\n"), "");
  EXPECT_EQ(answer_to(place_,
                      "GET /" + std::string(15'000, 'x') + std::string(15'000, 'y') +
                          " HTTP/1.1\r\n\r\n"),
            "");
  EXPECT_THAT(get(place_, place_.path), StartsWith("HTTP/1.1 200"));
}

TEST_F(ServerForPages, TakesGivenAddressesAndRefusesThoseInUse) {
  const ViewAddress address{
      "127.0.0.1", static_cast<std::uint16_t>(place_.port), "0123456789abcdef"};
  try {
    const ViewServer second(address, {});
    ADD_FAILURE() << "two servers on one port";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("cannot be listened on: Address already in use"));
  }
  server_.reset();
  const ViewServer again(address, {});
  EXPECT_EQ(again.url(), "http://127.0.0.1:" + std::to_string(place_.port) + "/0123456789abcdef/");
}

// The handshake's accept key is the one of RFC 6455, section 1.3.
TEST_F(ServerForPages, APageThatNeverAsksHoldsNothingUp) {
  const int fd = connected_socket(place_);
  send_text(fd,
            "GET " + place_.path +
                "socket HTTP/1.1\r\nHost: x\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
                "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n");
  std::array<char, 1024> part{};
  const ssize_t size = recv(fd, part.data(), part.size(), 0);
  ASSERT_GT(size, 0);
  const std::string answer(part.data(), static_cast<std::size_t>(size));
  EXPECT_THAT(answer, StartsWith("HTTP/1.1 101"));
  EXPECT_THAT(answer, HasSubstr("s3pPLMBiTxaQ9kYGzzhZRbK+xOo="));
  for (int i = 0; i < 5000; ++i) {
    if (server_->inbox().put_frame({}, std::nullopt)) server_->wake();
  }
  EXPECT_THAT(get(place_, place_.path), StartsWith("HTTP/1.1 200"));
  // It counts as open until it goes, and not for ever after.
  close(fd);
  server_->wait_until_alone();
}

}  // namespace
}  // namespace stillmap
