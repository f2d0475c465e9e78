// SPDX-License-Identifier: Apache-2.0
// make_corpus FOLDER: valid inputs for all fuzzers but that of sessions, in a folder for each. They
// are made here, because many are large and none is precious.
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "stillmap/config/config_io.hpp"
#include "stillmap/core/append_bytes.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "stillmap/io/image_io.hpp"
#include "stillmap/io/ply.hpp"
#include "stillmap/sensor/camera_io.hpp"
#include "tests/support/bridge_messages.hpp"
#include "tests/support/oni_writer.hpp"
#include "tests/support/sample_config.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;

ColorImage random_color(int width, int height) {
  std::mt19937 rng(1);
  cv::Mat3b rgb(height, width);
  for (cv::Vec3b& pixel : rgb) pixel = {static_cast<std::uint8_t>(rng()), 100, 200};
  return ColorImage(rgb);
}

PointCloud some_points() {
  PointCloud cloud;
  for (int i = 0; i < 5; ++i) {
    cloud.positions.emplace_back(0.1F * static_cast<float>(i), -1.5F, 2.F);
    cloud.colors.push_back({1, 2, 3});
    cloud.labels.push_back(static_cast<std::uint8_t>(i));
    cloud.normals.emplace_back(0.F, 0.F, 1.F);
  }
  return cloud;
}

void write(const fs::path& folder, const std::string& fuzzer, const std::vector<std::string>& all) {
  fs::create_directories(folder / fuzzer);
  for (std::size_t i = 0; i < all.size(); ++i) {
    write_file_atomically(folder / fuzzer / fmt::format("valid_{}", i), all[i]);
  }
}

void write_images(const fs::path& folder) {
  const cv::Mat1b mask(8, 6, std::uint8_t{3});
  write(folder,
        "png",
        {encode_png(random_color(7, 5)),
         encode_mask_png(mask),
         encode_depth_png(DepthImage(cv::Mat1f(4, 4, 1.5F)), 5000)});
  std::vector<std::string> jpegs;
  for (const int quality : {10, 95}) {
    const std::vector<std::uint8_t> bytes = encode_jpeg(random_color(20, 17), quality);
    jpegs.emplace_back(bytes.begin(), bytes.end());
  }
  write(folder, "jpeg", jpegs);
}

void write_texts(const fs::path& folder) {
  write(folder,
        "lists",
        {"# timestamp filename\n1.5 rgb/1.5.png\n2.5 rgb/2.5.png\n----\n1.51 depth/1.png\n"
         "2.49 depth/2.png\n----\n",
         "1 rgb/1.png\r\n----\n----\n1.0 rgb/1.png 1.01 depth/1.png\n"});
  write(folder,
        "trajectory",
        {"# stamp tx ty tz qx qy qz qw\n1.5 1 2 3 0 0 0 1\n2.5e0 -1 0.5 .25 0.5 0.5 0.5 0.5\n"});
  test::Config config;
  write(folder,
        "config",
        {dump_yaml(list_fields(config)), "tracking: {features: 500}\n", "tracking.features=500"});
  write(folder,
        "camera",
        {format_camera_yaml(builtin_camera("tum_fr1")),
         R"({"camera":{"width":640,"height":480,"fx":500,"fy":500,"cx":320,"cy":240}})"});
  write(folder,
        "live_record",
        {R"({"stamp":"1.5","frame":0,"objects_of":[0]})"
         "\n"
         R"({"stamp":"1.6","frame":2,"objects_of":[]})"
         "\n"});
}

// Files of an input of the fuzzer of layouts.
std::string layout(const std::vector<std::pair<std::string, std::string>>& files) {
  std::string text;
  for (const auto& [name, content] : files) text += name + "\n" + content + "----\n";
  return text;
}

void write_layouts(const fs::path& folder) {
  const std::string color = encode_png(random_color(4, 3));
  const std::string depth = encode_depth_png(DepthImage(cv::Mat1f(3, 4, 1.5F)), 1000);
  const std::string pose = "1 0 0 0\n0 1 0 0\n0 0 1 0.5\n0 0 0 1\n";
  const std::string intrinsics = "20 0 7.5 0\n0 21 5.25 0\n0 0 1 0\n0 0 0 1\n";
  const std::string csv = "#timestamp [ns],filename\n1000000000,1.png\n2000000000,2.png\n";
  const std::string sensor =
      "sensor_type: camera\nT_BS:\n  cols: 4\n  rows: 4\n  data: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, "
      "0, 0, 0, 0, 1]\nresolution: [4, 3]\ncamera_model: pinhole\nintrinsics: [4, 4, 2, 1.5]\n"
      "distortion_model: radial-tangential\ndistortion_coefficients: [0, 0, 0, 0]\n";
  std::string right = sensor;
  right.replace(right.find("[1, 0, 0, 0"), 11, "[1, 0, 0, 0.1");
  write(folder,
        "layouts",
        {layout({{"frame-000000.color.png", color},
                 {"frame-000000.depth.png", depth},
                 {"frame-000000.pose.txt", pose}}),
         layout({{"color/0.png", color},
                 {"depth/0.png", depth},
                 {"pose/0.txt", pose},
                 {"intrinsic/intrinsic_depth.txt", intrinsics}}),
         layout({{"color/000000.png", color},
                 {"depth/000000.png", depth},
                 {"camera_intrinsic.json",
                  R"({"width":4,"height":3,"intrinsic_matrix":[20,0,0,0,21,0,7.5,5.25,1]})"},
                 {"trajectory.log", "0 0 1\n" + pose}}),
         layout({{"associations.txt", "1 depth/1.png 1 rgb/1.png\n2 depth/2.png 2 rgb/2.png\n"},
                 {"living.gt.freiburg", "1 0 0 0 0 0 0 1\n2 0 0 1 0 0 0 1\n"}}),
         layout({{"cam0/data.csv", csv},
                 {"cam0/sensor.yaml", sensor},
                 {"cam0/data/1.png", color},
                 {"cam1/data.csv", csv},
                 {"cam1/sensor.yaml", right},
                 {"cam1/data/1.png", color},
                 {"state_groundtruth_estimate0/data.csv",
                  "#timestamp,p,q\n1000000000,0,0,0,1,0,0,0\n2000000000,0,0,1,1,0,0,0\n"}}),
         layout({{"calib.txt", "P0: 4 0 2 0 0 4 1.5 0 0 0 1 0\nP1: 4 0 2 -2 0 4 1.5 0 0 0 1 0\n"},
                 {"times.txt", "0.0\n0.1\n"},
                 {"image_0/000000.png", color},
                 {"image_1/000000.png", color},
                 {"poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 1\n"}})});
}

// Little endian, as messages of ROS are.
std::string u32(std::uint32_t value) {
  std::string bytes;
  append_bytes(bytes, value);
  return bytes;
}

std::string ros_text(const std::string& text) {
  return u32(static_cast<std::uint32_t>(text.size())) + text;
}

void write_ros_messages(const fs::path& folder) {
  const std::string header = u32(7) + u32(1500000000) + u32(250000000) + ros_text("camera");
  const auto image = [&](const std::string& encoding, std::uint32_t row, std::size_t size) {
    return header + u32(3) + u32(4) + ros_text(encoding) + '\0' + u32(row) +
           ros_text(std::string(size, 'x'));
  };
  std::string info = header + u32(480) + u32(640) + ros_text("plumb_bob") + u32(5);
  for (const double value :
       {0.1,   0.2, 0.0,   0.0, 0.0,                            // D
        500.0, 0.0, 320.0, 0.0, 500.0, 240.0, 0.0,   0.0, 1.0,  // K
        1.0,   0.0, 0.0,   0.0, 1.0,   0.0,   0.0,   0.0, 1.0,  // R
        500.0, 0.0, 320.0, 0.0, 0.0,   500.0, 240.0, 0.0, 0.0, 0.0, 1.0, 0.0}) {
    append_bytes(info, value);
  }
  const std::string png = encode_png(random_color(4, 3));
  write(folder,
        "ros_message",
        {image("rgb8", 12, 36),
         image("mono16", 8, 24),
         image("32FC1", 16, 48),
         header + ros_text("rgb8; png compressed bgr8") + ros_text(png),
         info + std::string(25, '\0'),
         std::string("\0\0\x80\x3f", 4)});
}

// The first byte says how the others are read: '0' as JSON, '1' as CBOR
// (fuzz/rosbridge_fuzzer.cpp).
void write_rosbridge_messages(const fs::path& folder) {
  const cv::Mat3b color(3, 4, cv::Vec3b(1, 2, 3));
  const cv::Mat1w depth(3, 4, std::uint16_t{1500});
  std::vector<std::string> all;
  for (const BridgeCoding coding : {BridgeCoding::kJson, BridgeCoding::kCbor}) {
    for (const nlohmann::json& content : {image_value(color, "rgb8", 5, coding),
                                          image_value(depth, "16UC1", 5, coding),
                                          info_value(builtin_camera("tum_fr1"))}) {
      all.push_back((coding == BridgeCoding::kCbor ? "1" : "0") +
                    encoded(published("/camera", content), coding));
    }
  }
  all.emplace_back(
      R"(0{"op":"service_response","id":"t","result":true,"values":{"topics":["/a"],"types":["sensor_msgs/Image"]}})");
  write(folder, "rosbridge", all);
}

void write_oni_files(const fs::path& folder) {
  std::vector<std::string> all;
  for (const char* codec : {"16zT", "16zP"}) {
    OniWriter writer;
    writer.add_stream(1, OniWriter::kColor, "NONE", {4, 3});
    writer.add_stream(2, OniWriter::kDepth, codec, {4, 3});
    writer.field_of_view(1, 1, 0.8);
    writer.integer(2, "xnMirror", 1);
    writer.image(1, 5, std::string(36, 'x'));
    writer.image(2, 5, encode_oni_depth(cv::Mat1w(3, 4, std::uint16_t{1500}), codec[3] == 'T'));
    writer.end();
    all.push_back(writer.bytes());
  }
  write(folder, "oni", all);
}

}  // namespace

void write_corpus(const fs::path& folder) {
  write_images(folder);
  write_texts(folder);
  write_layouts(folder);
  write_ros_messages(folder);
  write_rosbridge_messages(folder);
  write_oni_files(folder);
  write(folder,
        "ply",
        {encode_ply(some_points()), encode_ply(some_points(), PlyFormat::kAscii), encode_ply({})});
  cv::Mat1b mask = cv::Mat1b::zeros(24, 32);
  mask(5, 6) = 4;
  const std::string line =
      R"({"stamp":"1.5","objects":[{"id":4,"class":"person","score":0.5,"box":[1,2,30,20]}]})";
  write(folder, "detections", {line + "\n----\n", line + "\n----\n" + encode_mask_png(mask)});
  using namespace std::string_literals;
  write(
      folder,
      "export_kind",
      {"{0: 'person', 1: \"chair\"}----\nsegment----\n\x01\x04\x01\x03\x40\x40\x01\x04\x01\x02\x10\x10\x40\x01"s,
       "----\n----\n\x01\x04\x01\x03\x40\x40\x01\x03\x01\x54\x15\x00\x01"s});
}

}  // namespace stillmap

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  stillmap::write_corpus(argv[1]);
}
