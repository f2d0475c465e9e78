// SPDX-License-Identifier: Apache-2.0
// `stillmap segment` with a detections folder in place of a network.
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "stillmap/io/image_io.hpp"
#include "tests/support/cli_fixture.hpp"

namespace stillmap {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

class Segment : public Cli {
 protected:
  const cv::Rect kThing{3, 4, 24, 34};
  // Three frames of 64x48 that show a thing at 1 m; detections of them in found/, a mask for the
  // second.
  Segment() {
    for (const char* folder : {"s/rgb", "s/depth", "s/truth", "found/masks"}) {
      std::filesystem::create_directories(folder_ / folder);
    }
    const ColorImage color(cv::Mat3b(48, 64, cv::Vec3b(9, 99, 199)));
    const DepthImage depth(cv::Mat1f(48, 64, 2.0F));
    depth.mat(kThing).setTo(1.0F);
    write("s/camera.yaml",
          "width: 64\nheight: 48\nfx: 60\nfy: 60\ncx: 32\ncy: 24\ndepth_factor: 5000\n");
    std::string rgb, depths, lines;
    for (const char* stamp : {"1.0", "1.1", "1.2"}) {
      const std::string name = std::string(stamp) + ".png";
      write("s/rgb/" + name, encode_png(color));
      write("s/depth/" + name, encode_depth_png(depth, 5000));
      rgb += std::string(stamp) + " rgb/" + name + '\n';
      depths += std::string(stamp) + " depth/" + name + '\n';
      lines +=
          "{\"stamp\":\"" + std::string(stamp) +
          "\",\"objects\":[{\"id\":4,\"class\":\"person\",\"score\":0.5,\"box\":[1,2,30,40]}]}\n";
    }
    write("s/rgb.txt", rgb);
    write("s/depth.txt", depths);
    write("found/detections.jsonl", lines);
    cv::Mat1b mask = cv::Mat1b::zeros(48, 64);
    mask(5, 6) = 4;
    write("found/masks/1.1.png", encode_mask_png(mask));
  }
};

// Boxes alone get masks by depth; the network's mask stays.
TEST_F(Segment, WritesTheFolder) {
  const Outcome outcome = run("segment s --out again --segmenter detections:found --threads 3");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.err, IsEmpty());
  EXPECT_THAT(outcome.out, StartsWith("detections  3 objects in 3 frames, in again\n"));
  const std::string object = R"([{"id":1,"class":"person","score":0.5,"box":[1,2,30,40])";
  EXPECT_EQ(content("again/detections.jsonl"),
            R"({"stamp":"1.0","objects":)" + object + ",\"mask\":\"depth\"}]}\n" +
                R"({"stamp":"1.1","objects":)" + object + "}]}\n" + R"({"stamp":"1.2","objects":)" +
                object + ",\"mask\":\"depth\"}]}\n");
  const cv::Mat1b given = read_mask(folder_ / "again/masks/1.1.png");
  EXPECT_EQ(given(5, 6), 1);
  EXPECT_EQ(cv::countNonZero(given), 1);
  const cv::Mat1b by_depth = read_mask(folder_ / "again/masks/1.0.png");
  EXPECT_GT(cv::countNonZero(by_depth(kThing)), 0.9 * kThing.area());
  EXPECT_LT(cv::countNonZero(by_depth), 1.1 * kThing.area());
}

TEST_F(Segment, LeavesMasksByDepthToTheRunWhereNoCameraIsKnown) {
  std::filesystem::remove(folder_ / "s/camera.yaml");
  const Outcome outcome = run("segment s --out again --segmenter detections:found");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.err, HasSubstr("masks by depth are left to `stillmap run`"));
  EXPECT_EQ(content("again/detections.jsonl"), content("found/detections.jsonl"));
  EXPECT_EQ(read_mask(folder_ / "again/masks/1.1.png")(5, 6), 4);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "again/masks/1.0.png"));
  expect_refused("segment s --out more --segmenter detections:found --camera none.yaml",
                 "none.yaml");
}

// The images are called by numbers, and so are the masks.
TEST_F(Segment, TakesPlainMasksNamedAsTheImages) {
  std::filesystem::create_directories(folder_ / "people");
  std::string rgb;
  for (const char* stamp : {"1.0", "1.1", "1.2"}) {
    const std::string name = "image" + std::string(1, stamp[2]);
    std::filesystem::rename(folder_ / "s/rgb" / (std::string(stamp) + ".png"),
                            folder_ / "s/rgb" / (name + ".png"));
    rgb += std::string(stamp) + " rgb/" + name + ".png\n";
    cv::Mat1b mask = cv::Mat1b::zeros(48, 64);
    if (stamp[2] == '1') mask(cv::Rect(10, 20, 8, 16)).setTo(255);
    write("people/" + name + ".png", encode_mask_png(mask));
  }
  write("s/rgb.txt", rgb);
  const Outcome outcome = run("segment s --out again --segmenter masks:people");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.err, IsEmpty());
  EXPECT_EQ(content("again/detections.jsonl"),
            "{\"stamp\":\"1.0\",\"objects\":[]}\n"
            "{\"stamp\":\"1.1\",\"objects\":[{\"id\":1,\"class\":\"person\",\"score\":1,"
            "\"box\":[10,20,18,36]}]}\n"
            "{\"stamp\":\"1.2\",\"objects\":[]}\n");
  std::filesystem::remove(folder_ / "people/image2.png");
  expect_refused("segment s --out more --segmenter masks:people", "image2.png: no such mask");
  expect_refused("segment s --out people --segmenter masks:people", "would be overwritten");
}

TEST_F(Segment, NamesClassesThatNobodyKnows) {
  std::string lines = content("found/detections.jsonl");
  lines.replace(lines.find("person"), 6, "pallet");
  lines.replace(lines.find("person"), 6, "Worker");
  write("found/detections.jsonl", lines);
  const Outcome outcome = run("segment s --out again --segmenter detections:found");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.err,
              StartsWith("stillmap: warning: classes that no category knows are taken "
                         "for static: pallet; "));
}

TEST_F(Segment, ADamagedImageIsAFrameWithoutObjects) {
  write("s/rgb/1.1.png", "");
  const Outcome outcome = run("segment s --out again --segmenter detections:found");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.err, StartsWith("stillmap: warning: "));
  EXPECT_THAT(outcome.err, HasSubstr("1.1.png"));
  EXPECT_THAT(content("again/detections.jsonl"), HasSubstr("{\"stamp\":\"1.1\",\"objects\":[]}\n"));
}

TEST_F(Segment, NeverOverwritesItsInput) {
  for (const char* out : {"s", "s/", "s/truth", "s/x/../truth", "s/rgb/x", "found"}) {
    const Outcome outcome =
        run("segment s --out " + std::string(out) + " --segmenter detections:found");
    EXPECT_EQ(outcome.exit_code, 2) << out;
    EXPECT_THAT(outcome.err, HasSubstr("would be overwritten")) << out;
  }
}

TEST_F(Segment, SaysWhatIsMissing) {
  const Outcome models = run("segment s --out again --segmenter auto", "STILLMAP_MODELS=none");
  EXPECT_EQ(models.exit_code, 2);
  EXPECT_THAT(models.err, HasSubstr("run tools/fetch_models"));
  EXPECT_THAT(run("segment s --out again --segmenter yolo").err,
              HasSubstr("--segmenter yolo: expected detections:DIR"));
  EXPECT_THAT(run("segment none --out again --segmenter detections:found").err,
              HasSubstr("none: no such file or folder"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "again"));
}

}  // namespace
}  // namespace stillmap
