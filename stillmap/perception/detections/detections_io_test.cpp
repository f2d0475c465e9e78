// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/detections/detections_io.hpp"

#include <filesystem>
#include <fstream>
#include <random>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "stillmap/io/atomic_file.hpp"
#include "stillmap/io/image_io.hpp"
#include "stillmap/io/stamp_text.hpp"
#include "stillmap/perception/detections/class_names.hpp"
#include "stillmap/sensor/sequence.hpp"
#include "tests/support/files.hpp"
#include "tests/support/shared_data.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

const cv::Size kSmallImage(40, 30);

Stamp stamp_of(const std::string& text) {
  return {std::stod(text), text};
}

FrameDetections two_objects(const std::string& stamp) {
  FrameDetections frame;
  frame.stamp = stamp_of(stamp);
  frame.objects = {{7, "person", 0.5F, {0, 0, 10, 10}}, {9, "chair", 0.25F, {5, 5, 20, 30}}};
  frame.mask.mat = cv::Mat1b(kSmallImage, std::uint8_t{0});
  frame.mask.mat(cv::Rect(0, 0, 10, 10)).setTo(7);
  frame.mask.mat(cv::Rect(5, 10, 15, 20)).setTo(9);
  return frame;
}

void write_folder(const fs::path& folder, const std::vector<FrameDetections>& frames) {
  DetectionsWriter writer(folder, kSmallImage);
  for (const FrameDetections& frame : frames) writer.add(frame);
  writer.finish();
}

void write_list(const fs::path& folder, const std::string& text) {
  fs::create_directories(folder / "masks");
  write_file_atomically(folder / "detections.jsonl", text);
}

std::string open_error(const fs::path& folder) {
  return error_of([&] { (void)DetectionsFolder::open(folder, kSmallImage); });
}

void expect_same(const FrameDetections& found, const FrameDetections& expected) {
  EXPECT_EQ(found.stamp.text, expected.stamp.text);
  EXPECT_EQ(found.objects, expected.objects);
  ASSERT_EQ(found.mask.mat.size(), expected.mask.mat.size());
  if (!expected.mask.mat.empty()) {
    EXPECT_EQ(cv::norm(found.mask.mat, expected.mask.mat, cv::NORM_INF), 0);
  }
}

TEST(DetectionsFolder, GivesBackWhatWasWritten) {
  const TemporaryFolder folder;
  FrameDetections without_pixels;
  without_pixels.stamp = stamp_of("2.25");
  without_pixels.objects = {{1, "dog", 0.125F, {-3.5, 0, 20, 30}}};
  FrameDetections nothing;
  nothing.stamp = stamp_of("3.0");
  const std::vector<FrameDetections> frames = {two_objects("1.5"), without_pixels, nothing};
  write_folder(folder.path() / "a" / "b", frames);

  const DetectionsFolder read = DetectionsFolder::open(folder.path() / "a" / "b", kSmallImage);
  ASSERT_EQ(read.size(), 3U);
  for (const FrameDetections& frame : frames) expect_same(read.at(frame.stamp), frame);
  EXPECT_FALSE(fs::exists(folder.path() / "a" / "b" / "masks" / "2.25.png"));
}

TEST(DetectionsFolder, KnowsAStampByItsNumber) {
  const TemporaryFolder folder;
  write_folder(folder.path(), {two_objects("1.500000"), two_objects("2.5")});
  const DetectionsFolder read = DetectionsFolder::open(folder.path(), kSmallImage);
  EXPECT_EQ(read.at(stamp_of("1.5")).stamp.text, "1.500000");
  EXPECT_EQ(read.at(stamp_of("2.50")).stamp.text, "2.5");
  EXPECT_TRUE(read.contains(stamp_of("2.5")));
  EXPECT_FALSE(read.contains(stamp_of("2.500001")));
  const std::string error = error_of([&] { (void)read.at(stamp_of("2.500001")); });
  EXPECT_THAT(error, StartsWith(folder.path().string() + "/detections.jsonl: no line for"));
  EXPECT_THAT(error, HasSubstr("2.500001"));
}

TEST(DetectionsFolder, IsWhatAnotherLibraryReads) {
  const TemporaryFolder folder;
  write_folder(folder.path(), {two_objects("1.5"), two_objects("2.5")});
  std::ifstream list(folder.path() / "detections.jsonl");
  std::vector<nlohmann::json> lines;
  for (std::string line; std::getline(list, line);) lines.push_back(nlohmann::json::parse(line));
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(
      lines[1],
      nlohmann::json::parse(
          R"({"stamp":"2.5","objects":[{"id":7,"class":"person","score":0.5,"box":[0,0,10,10]},)"
          R"({"id":9,"class":"chair","score":0.25,"box":[5,5,20,30]}]})"));
}

TEST(DetectionsFolder, TakesBlankLinesAndWindowsLineEnds) {
  const TemporaryFolder folder;
  write_list(folder.path(),
             "{\"stamp\":\"1\",\"objects\":[]}\r\n\r\n\n{\"stamp\":\"2\",\"objects\":[]}");
  EXPECT_EQ(DetectionsFolder::open(folder.path(), kSmallImage).size(), 2U);
}

TEST(DetectionsFolder, RefusesAListThatIsMissingEmptyOrOutOfOrder) {
  const TemporaryFolder folder;
  EXPECT_THAT(open_error(folder.path()), HasSubstr("detections.jsonl"));
  write_list(folder.path(), "\n \n");
  EXPECT_THAT(open_error(folder.path()), HasSubstr("no frame in it"));
  const std::string one = "{\"stamp\":\"1\",\"objects\":[]}\n";
  write_list(folder.path(), one + "\n" + one);
  EXPECT_THAT(open_error(folder.path()), HasSubstr("detections.jsonl:3: stamp 1 is not later"));
  write_list(folder.path(), one + "{\"stamp\":\"1.0\",\"objects\":[]}\n");
  EXPECT_THAT(open_error(folder.path()), HasSubstr("detections.jsonl:2: stamp 1.0 is not later"));
  write_list(folder.path(), one + "{\"stamp\":\"0.5\",\"objects\":[]}\n");
  EXPECT_THAT(open_error(folder.path()), HasSubstr("detections.jsonl:2: "));
}

TEST(DetectionsFolder, SaysWhichLineIsCutOff) {
  const TemporaryFolder folder;
  write_folder(folder.path(), {two_objects("1.5"), two_objects("2.5")});
  const std::string whole = read_file(folder.path() / "detections.jsonl", 10000);
  const std::size_t second = whole.find('\n') + 1;
  for (std::size_t size = second + 1; size + 1 < whole.size(); ++size) {
    write_list(folder.path(), whole.substr(0, size));
    EXPECT_THAT(open_error(folder.path()), HasSubstr("detections.jsonl:2: ")) << size;
  }
}

TEST(DetectionsFolder, RefusesOrReadsWhateverBytesChange) {
  const TemporaryFolder folder;
  write_folder(folder.path(), {two_objects("1.5"), two_objects("2.5")});
  const std::string whole = read_file(folder.path() / "detections.jsonl", 10000);
  std::mt19937 rng(5);
  int refused = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    std::string damaged = whole;
    damaged[rng() % damaged.size()] = static_cast<char>(rng());
    write_list(folder.path(), damaged);
    try {
      EXPECT_GE(DetectionsFolder::open(folder.path(), kSmallImage).size(), 1U);
    } catch (const Error& error) {
      ++refused;
      EXPECT_THAT(error.what(), HasSubstr("detections.jsonl:"));
    }
  }
  EXPECT_GT(refused, 1000);
}

TEST(DetectionsFolder, RefusesMasksThatDoNotFitTheirLine) {
  const TemporaryFolder folder;
  write_folder(folder.path(), {two_objects("1.5")});
  const fs::path mask = folder.path() / "masks" / "1.5.png";
  const DetectionsFolder read = DetectionsFolder::open(folder.path(), kSmallImage);
  const auto error = [&] { return error_of([&] { (void)read.at(stamp_of("1.5")); }); };

  cv::Mat1b stranger(kSmallImage, std::uint8_t{0});
  stranger(29, 39) = 8;
  write_file_atomically(mask, encode_mask_png(stranger));
  EXPECT_EQ(error(),
            mask.string() + ": has pixels of id 8, which " + folder.path().string() +
                "/detections.jsonl:1 has not");
  write_file_atomically(mask, encode_mask_png(cv::Mat1b(40, 30, std::uint8_t{7})));
  EXPECT_EQ(error(), mask.string() + ": 30x40 pixels, expected 40x30 as the images have");
  write_file_atomically(mask, encode_depth_png(DepthImage(cv::Mat1f(kSmallImage, 1.F)), 5000));
  EXPECT_THAT(error(), StartsWith(mask.string()));
  write_file_atomically(mask, "");
  EXPECT_THAT(error(), StartsWith(mask.string()));
}

std::string line_of(const std::string& stamp, const std::string& box) {
  return R"({"stamp":")" + stamp + R"(","objects":[{"id":7,"class":"person","score":1,"box":)" +
         box + "}]}\n";
}

TEST(DetectionsFolder, NoticesBoxesInShares) {
  const TemporaryFolder folder;
  const std::string none = "{\"stamp\":\"1\",\"objects\":[]}\n";
  write_list(folder.path(),
             none + line_of("2", "[0.25,0.1,0.75,1.0]") + line_of("3", "[0,0,0.5,1.02]"));
  EXPECT_THAT(open_error(folder.path()),
              testing::AllOf(HasSubstr("detections.jsonl:2: box [0.25, 0.1, 0.75, 1]"),
                             HasSubstr("in pixels, not in shares")));
  // A box of the corner pixel is valid among other boxes.
  write_list(folder.path(), none + line_of("2", "[0,0,1,1]") + line_of("3", "[0,0,20,30]"));
  EXPECT_EQ(DetectionsFolder::open(folder.path(), kSmallImage).size(), 3U);
}

TEST(DetectionsFolder, NoticesBoxesOfWidthAndHeight) {
  const TemporaryFolder folder;
  // Pixels from (5, 4) to (25, 22): 20 wide, 18 high.
  cv::Mat1b mask(kSmallImage, std::uint8_t{0});
  mask(cv::Rect(5, 4, 20, 18)).setTo(7);
  const auto error = [&](const std::string& box) {
    write_list(folder.path(), line_of("1", box));
    write_file_atomically(folder.path() / "masks" / "1.png", encode_mask_png(mask));
    const DetectionsFolder read = DetectionsFolder::open(folder.path(), kSmallImage);
    return error_of([&] { (void)read.at(stamp_of("1")); });
  };
  EXPECT_THAT(error("[5,4,20,18]"),
              testing::AllOf(HasSubstr("detections.jsonl:1: object 7: box [5, 4, 20, 18]"),
                             HasSubstr("expected [x0, y0, x1, y1]")));
  write_list(folder.path(), line_of("1", "[20,4,8,18]"));
  EXPECT_THAT(open_error(folder.path()), HasSubstr("is it COCO's [x, y, width, height]?"));
  // Valid boxes, and one that holds only a part of the object.
  for (const char* box : {"[5,4,25,22]", "[4,3,26,24]", "[5,4,15,22]"}) {
    write_list(folder.path(), line_of("1", box));
    EXPECT_EQ(DetectionsFolder::open(folder.path(), kSmallImage).at(stamp_of("1")).objects.size(),
              1U);
  }
}

TEST(DetectionsFolder, AMaskWithoutPixelsIsNone) {
  const TemporaryFolder folder;
  FrameDetections frame = two_objects("1.5");
  frame.mask.mat.setTo(0);
  write_folder(folder.path(), {frame});
  EXPECT_TRUE(fs::exists(folder.path() / "masks" / "1.5.png"));
  const DetectionsFolder read = DetectionsFolder::open(folder.path(), kSmallImage);
  EXPECT_TRUE(read.at(frame.stamp).mask.mat.empty());
}

TEST(DetectionsWriter, LeavesTheOldUntilItIsFinished) {
  const TemporaryFolder folder;
  write_folder(folder.path(), {two_objects("1.5"), two_objects("1.6")});
  write_file_atomically(folder.path() / "masks" / "person7.png", "of another program");
  FrameDetections nothing;
  nothing.stamp = stamp_of("1.5");
  {
    DetectionsWriter given_up(folder.path(), kSmallImage);
    given_up.add(nothing);
  }
  EXPECT_EQ(DetectionsFolder::open(folder.path(), kSmallImage).size(), 2U);
  DetectionsWriter writer(folder.path(), kSmallImage);
  writer.add(nothing);
  EXPECT_FALSE(
      DetectionsFolder::open(folder.path(), kSmallImage).at(nothing.stamp).mask.mat.empty());
  writer.finish();
  EXPECT_EQ(DetectionsFolder::open(folder.path(), kSmallImage).size(), 1U);
  EXPECT_TRUE(
      DetectionsFolder::open(folder.path(), kSmallImage).at(nothing.stamp).mask.mat.empty());
  EXPECT_FALSE(fs::exists(folder.path() / "masks" / "1.6.png")) << "the mask of an earlier time";
  EXPECT_TRUE(fs::exists(folder.path() / "masks" / "person7.png"));
}

// Whatever stamps and classes a run takes, a folder of detections has.
TEST(DetectionsWriter, TakesEveryStampAndClass) {
  const TemporaryFolder folder;
  std::vector<FrameDetections> frames;
  for (const char* stamp : {"-2.5", "-1.", "0", "1.5e0", "2e9", "3000000000.25"}) {
    frames.push_back(two_objects(stamp));
    frames.back().stamp = parse_stamp(stamp).value();
    frames.back().objects[0].class_name = "Fu\u00DFg\u00E4nger";
    frames.back().objects[1].class_name = "\u4EBA";
  }
  write_folder(folder.path(), frames);
  const DetectionsFolder read = DetectionsFolder::open(folder.path(), kSmallImage);
  for (const FrameDetections& frame : frames) {
    const FrameDetections again = read.at(frame.stamp);
    EXPECT_EQ(again.stamp.text, frame.stamp.text);
    EXPECT_EQ(again.objects, frame.objects);
    EXPECT_EQ(cv::countNonZero(again.mask.mat != frame.mask.mat), 0);
  }
}

TEST(DetectionsWriter, RefusesWhatCouldNotBeReadBack) {
  const TemporaryFolder folder;
  const auto error = [&](const FrameDetections& frame) {
    DetectionsWriter writer(folder.path(), kSmallImage);
    return error_of([&] { writer.add(frame); });
  };
  FrameDetections path = two_objects("1.5");
  path.stamp.text = "../1.5";
  EXPECT_THAT(error(path), HasSubstr("no finite number"));
  FrameDetections stranger = two_objects("1.5");
  stranger.objects.pop_back();
  EXPECT_THAT(error(stranger), HasSubstr("id 9"));
  FrameDetections nan = two_objects("1.5");
  nan.objects[0].score = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(error(nan), HasSubstr("detections.jsonl:1: "));
  FrameDetections small = two_objects("1.5");
  small.mask.mat = cv::Mat1b(20, 20, std::uint8_t{0});
  EXPECT_THAT(error(small), HasSubstr("20x20"));
  DetectionsWriter writer(folder.path(), kSmallImage);
  writer.add(two_objects("2"));
  EXPECT_THAT(error_of([&] { writer.add(two_objects("2.0")); }), HasSubstr("not later"));
}

TEST(DetectionsWriter, SaysWhenItCannotWrite) {
  const TemporaryFolder folder;
  write_file_atomically(folder.path() / "file", "x");
  EXPECT_THAT(error_of([&] { DetectionsWriter writer(folder.path() / "file", kSmallImage); }),
              HasSubstr("cannot be made"));
}

// Compares every frame of the given sequences with the pixels that its line promises.
TEST(DetectionsFolder, ReadsThoseOfARealNetwork) {
  for (const char* name : {"twin_walking_xyz", "fr1_xyz_walkers"}) {
    STILLMAP_NEED_SHARED_DATA(name);
    const Sequence sequence = Sequence::open(shared_data(name));
    const DetectionsFolder read =
        DetectionsFolder::open(shared_data(name) / "detections",
                               {sequence.camera().width_px, sequence.camera().height_px});
    EXPECT_GE(read.size(), sequence.size());
    std::size_t objects = 0, with_pixels = 0;
    for (std::uint32_t i = 0; i < sequence.size(); ++i) {
      const FrameDetections frame = read.at(sequence.entry(FrameId(i)).stamp);
      EXPECT_EQ(frame.stamp.text, sequence.entry(FrameId(i)).stamp.text);
      for (const DetectedObject& object : frame.objects) {
        ++objects;
        EXPECT_TRUE(is_coco_class(object.class_name)) << object.class_name;
        const cv::Rect box = cv::boundingRect(frame.mask.mat == object.id);
        with_pixels += box.empty() ? 0 : 1;
        EXPECT_LE(object.box.x0, box.x) << name << ' ' << i;
        EXPECT_GE(object.box.y1, box.y + box.height) << name << ' ' << i;
      }
    }
    EXPECT_GT(objects, 500U);
    EXPECT_EQ(with_pixels, objects);
  }
}

}  // namespace
}  // namespace stillmap
