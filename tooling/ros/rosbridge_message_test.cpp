// SPDX-License-Identifier: Apache-2.0
// Messages of rosbridge against encoders of others: nlohmann-json's of JSON and CBOR, and the
// examples of RFC 8949 and RFC 4648.
#include "tooling/ros/rosbridge_message.hpp"

#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "stillmap/io/image_io.hpp"
#include "tests/support/bridge_messages.hpp"
#include "tests/support/files.hpp"
#include "tooling/ros/cbor.hpp"

namespace stillmap {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::StartsWith;

std::string from_hex(std::string_view hex) {
  std::string bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2) {
    bytes += static_cast<char>(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16));
  }
  return bytes;
}

// Appendix A of RFC 8949.
TEST(Cbor, ReadsTheExamplesOfItsDefinition) {
  const auto read = [](std::string_view hex) { return read_cbor(from_hex(hex), "m"); };
  EXPECT_EQ(read("17"), 23);
  EXPECT_EQ(read("1903e8"), 1000);
  EXPECT_EQ(read("1bffffffffffffffff"), 18446744073709551615ULL);
  EXPECT_EQ(read("3903e7"), -1000);
  EXPECT_EQ(read("f93e00"), 1.5);
  EXPECT_EQ(read("f90001"), 5.960464477539063e-8);
  EXPECT_EQ(read("f9c400"), -4.0);
  EXPECT_EQ(read("fa47c35000"), 100000.0);
  EXPECT_EQ(read("fbc010666666666666"), -4.1);
  EXPECT_EQ(read("f97c00"), INFINITY);
  EXPECT_TRUE(std::isnan(read("f97e00").get<double>()));
  EXPECT_EQ(read("f5"), true);
  EXPECT_EQ(read("f6"), nullptr);
  EXPECT_EQ(read("4401020304"), json::binary({1, 2, 3, 4}));
  EXPECT_EQ(read("d74401020304"), json::binary({1, 2, 3, 4}, 23));
  EXPECT_EQ(read("62c3bc"), "\u00fc");
  EXPECT_EQ(read("826161a161626163"), json::parse(R"(["a",{"b":"c"}])"));
  EXPECT_EQ(read("98190102030405060708090a0b0c0d0e0f101112131415161718181819").size(), 25U);
  EXPECT_EQ(read("a56161614161626142616361436164614461656145")["e"], "E");
}

TEST(Cbor, RefusesWhatIsDamaged) {
  for (const char* hex : {"",                    // nothing
                          "18",                  // half an item
                          "0000",                // two items
                          "5bffffffffffffffff",  // bytes that are not there
                          "9bffffffffffffffff",  // values that are not there
                          "bbffffffffffffffff",
                          "a10102",              // a key that is no text
                          "3bffffffffffffffff",  // beyond 64 bits
                          "62c328",              // no UTF-8
                          "9f01ff",              // of unknown length
                          "f818",                // an unknown simple value
                          "d8"}) {
    EXPECT_THROW((void)read_cbor(from_hex(hex), "m"), DamagedImage) << hex;
  }
  // Where a reader by recursion would run out of stack.
  EXPECT_THROW((void)read_cbor(std::string(10'000'000, '\x81'), "m"), DamagedImage);
  EXPECT_THROW((void)read_cbor(std::string(10'000'000, '\xC6'), "m"), DamagedImage);
  // Many values take much more memory than their bytes.
  EXPECT_THAT(error_of([] {
                (void)read_cbor("\x9a" + from_hex("00989680") + std::string(10'000'000, '\x01'),
                                "m");
              }),
              HasSubstr("m: damaged CBOR: too many values"));
}

TEST(BridgeMessage, IsReadFromJsonAndCbor) {
  const json message = {{"op", "service_response"},
                        {"id", "q"},
                        {"values", {{"topics", {"/a", "/b"}}, {"types", {"x/msg/Y", "z/W"}}}},
                        {"result", true}};
  for (const BridgeCoding coding : {BridgeCoding::kJson, BridgeCoding::kCbor}) {
    const BridgeMessage read =
        read_bridge_message(encoded(message, coding), coding == BridgeCoding::kCbor, "m");
    EXPECT_EQ(read.op, "service_response");
    EXPECT_EQ(read.id, "q");
    EXPECT_TRUE(read.result);
    const std::vector<BridgeTopic> topics = bridged_topics(read.content, "m");
    ASSERT_EQ(topics.size(), 2U);
    EXPECT_EQ(topics[0].type, "x/Y");  // ROS 2
    EXPECT_EQ(topics[1].name, "/b");
    EXPECT_EQ(topics[1].type, "z/W");
  }
  for (const char* text : {"", "{", "[]", "{}", R"({"op":5})", "{\"op\":\"\xff\"}"}) {
    EXPECT_THROW((void)read_bridge_message(text, false, "m"), DamagedImage) << text;
  }
  EXPECT_THROW((void)read_bridge_message(std::string(1'000'000, '['), false, "m"), DamagedImage);
  std::string many = R"({"op":[0)";
  for (int i = 0; i < 200'000; ++i) many += ",0";
  EXPECT_THAT(error_of([&] { (void)read_bridge_message(many + "]}", false, "m"); }),
              HasSubstr("too many values"));
  EXPECT_THROW((void)bridged_topics(json::parse(R"({"topics":["/a"],"types":[]})"), "m"),
               DamagedImage);
}

cv::Mat random_pixels(int type) {
  cv::Mat pixels(23, 37, type);
  cv::RNG rng(7);
  rng.fill(pixels, cv::RNG::UNIFORM, 1, 255);
  return pixels;
}

BridgedImage image_of(const json& content, BridgeCoding coding) {
  const std::string bytes = encoded(published("/t", content), coding);
  return {read_bridge_message(bytes, coding == BridgeCoding::kCbor, "m").content, "m"};
}

TEST(BridgedImage, HasTheBitsOfTheSource) {
  const cv::Mat3b rgb = random_pixels(CV_8UC3);
  const cv::Mat1w units = random_pixels(CV_16UC1);
  const std::uint64_t stamp_ns = 1'600'000'000'033'333'333U;
  for (const BridgeCoding coding : {BridgeCoding::kJson, BridgeCoding::kCbor}) {
    const BridgedImage color = image_of(image_value(rgb, "rgb8", stamp_ns, coding), coding);
    EXPECT_EQ(color.kind(), RosImageKind::kColor);
    EXPECT_EQ(color.stamp().seconds, 1'600'000'000U);
    EXPECT_EQ(color.stamp().nanoseconds, 33'333'333U);
    EXPECT_EQ(cv::norm(color.color("m").mat, rgb, cv::NORM_INF), 0);
    const BridgedImage depth = image_of(image_value(units, "16UC1", stamp_ns, coding), coding);
    EXPECT_EQ(depth.kind(), RosImageKind::kDepth);
    EXPECT_EQ(depth.depth(500, "m").mat(3, 4), static_cast<float>(units(3, 4)) / 500.F);

    const std::string png = encode_png(ColorImage(rgb));
    const json compressed = {{"header", {{"stamp", {{"sec", 5}, {"nanosec", 6}}}}},  // ROS 2
                             {"format", "rgb8; png compressed bgr8"},
                             {"data", bytes_value(png, coding)}};
    const BridgedImage read = image_of(compressed, coding);
    EXPECT_EQ(read.type(), RosImageType::kCompressed);
    EXPECT_EQ(read.stamp().nanoseconds, 6U);
    EXPECT_EQ(cv::norm(read.color("m").mat, rgb, cv::NORM_INF), 0);
  }
}

// RFC 4648, section 10.
TEST(BridgedImage, ReadsBase64AndListsOfNumbers) {
  json content = image_value(cv::Mat1b(1, 6, std::uint8_t{0}), "mono8", 0, BridgeCoding::kJson);
  content["data"] = "Zm9vYmFy";
  EXPECT_EQ(BridgedImage(content, "m").color("m").mat(0, 5), cv::Vec3b('r', 'r', 'r'));
  content["data"] = {1, 2, 3, 4, 5, 255};
  EXPECT_EQ(BridgedImage(content, "m").color("m").mat(0, 5), cv::Vec3b(255, 255, 255));
  content["width"] = 4;
  content["step"] = 4;
  content["data"] = "Zm9vYg==";
  EXPECT_EQ(BridgedImage(content, "m").color("m").mat(0, 3), cv::Vec3b('b', 'b', 'b'));
  for (const json& data :
       {json("Zm9v!A=="), json({1, 2, 3, 256}), json({1, -2}), json(5), json()}) {
    content["data"] = data;
    EXPECT_THROW(BridgedImage(content, "m"), DamagedImage) << data;
  }
}

TEST(BridgedImage, OfAnotherSizeIsDamaged) {
  const json good = image_value(random_pixels(CV_8UC3), "rgb8", 5, BridgeCoding::kCbor);
  const auto error = [&](const char* name, const json& value) {
    json content = good;
    content[name] = value;
    return error_of([&] { (void)BridgedImage(content, "m").color("m"); });
  };
  EXPECT_THAT(error("height", 24), HasSubstr("m: 2553 bytes, expected 37x24 pixels of rgb8"));
  EXPECT_THAT(error("width", 38), HasSubstr("expected 38x23"));
  EXPECT_THAT(error("step", 110), HasSubstr("expected 37x23"));
  EXPECT_THAT(error("width", 4'000'000'000U), HasSubstr("an image of 4000000000x23"));
  EXPECT_THAT(error("height", -1), HasSubstr("'height' is no number"));
  EXPECT_THAT(error("width", 1e300), HasSubstr("'width' is no number"));
  EXPECT_THAT(error("encoding", "yuv422"), HasSubstr("encoding 'yuv422'"));
  EXPECT_THAT(error("header", json::object()), HasSubstr("without 'stamp'"));
}

TEST(BridgedCameraInfo, IsThatOfRos1AndRos2) {
  CameraModel camera;
  camera.width_px = 640;
  camera.height_px = 480;
  camera.fx = 500.25;
  camera.fy = 501;
  camera.cx = 320;
  camera.cy = 240;
  json content = info_value(camera);
  const RosCameraInfo info = bridged_camera_info(content, "m");
  EXPECT_EQ(info.width_px, 640U);
  EXPECT_EQ(info.intrinsics[0], 500.25);
  EXPECT_EQ(info.projection[6], 240);
  EXPECT_EQ(info.distortion, std::vector<double>(5, 0.0));
  for (const char* name : {"D", "K", "R", "P"}) {
    content[std::string(1, static_cast<char>(name[0] + 'a' - 'A'))] = content[name];
    content.erase(name);
  }
  EXPECT_EQ(bridged_camera_info(content, "m").intrinsics, info.intrinsics);
  // A typed array of CBOR: float64, little-endian.
  const std::array<double, 2> numbers = {0.5, -0.25};
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(numbers.data());
  content["d"] = json::binary({bytes, bytes + sizeof(numbers)}, 86);
  EXPECT_EQ(bridged_camera_info(content, "m").distortion, (std::vector<double>{0.5, -0.25}));
  content["k"] = {1, 2, 3};
  EXPECT_THAT(error_of([&] { (void)bridged_camera_info(content, "m"); }),
              HasSubstr("m: 'K' has 3 numbers, expected 9"));
  content["k"] = nullptr;
  EXPECT_THAT(error_of([&] { (void)bridged_camera_info(content, "m"); }),
              StartsWith("m: 'K' is no"));
}

// Any change of a message is read or refused.
TEST(BridgedImage, SurvivesRandomDamage) {
  std::mt19937 rng(3);
  for (const BridgeCoding coding : {BridgeCoding::kJson, BridgeCoding::kCbor}) {
    const std::string whole =
        encoded(published("/t", image_value(cv::Mat1w(3, 4, std::uint16_t{7}), "16UC1", 5, coding)),
                coding);
    std::size_t refused = 0;
    for (int i = 0; i < 5000; ++i) {
      std::string bytes = whole;
      for (unsigned changes = 1 + rng() % 3; changes > 0; --changes) {
        bytes[rng() % bytes.size()] = static_cast<char>(rng());
      }
      if (rng() % 4 == 0) bytes.resize(rng() % bytes.size());
      try {
        BridgedImage image(read_bridge_message(bytes, coding == BridgeCoding::kCbor, "m").content,
                           "m");
        (void)image.depth(1000, "m");
      } catch (const Error&) {
        ++refused;
      }
    }
    EXPECT_GT(refused, 1000U);
  }
}

}  // namespace
}  // namespace stillmap
