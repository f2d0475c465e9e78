// SPDX-License-Identifier: Apache-2.0
#include "stillmap/sensor/sequence.hpp"

#include <memory>
#include <thread>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "stillmap/io/atomic_file.hpp"
#include "stillmap/io/image_io.hpp"
#include "stillmap/sensor/camera_io.hpp"
#include "tests/support/files.hpp"
#include "tests/support/shared_data.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

CameraModel small_camera() {
  CameraModel camera;
  camera.name = "small";
  camera.width_px = 8;
  camera.height_px = 6;
  camera.fx = camera.fy = 10;
  camera.cx = 4;
  camera.cy = 3;
  camera.depth_factor = 1000;
  return camera;
}

// A sequence of two frames of 8x6 pixels, to be spoilt by the tests.
class SequenceTest : public ::testing::Test {
 protected:
  SequenceTest() : folder_(base_.path() / "sequence") {
    fs::create_directories(folder_ / "rgb");
    fs::create_directories(folder_ / "depth");
    write("rgb.txt", "# colour\n10.000 rgb/a.png\r\n\n10.10 rgb/b.jpg\n");
    write("depth.txt", "10.005 depth/a.png\n10.095 depth/b.png\n");
    write("camera.yaml", format_camera_yaml(small_camera()));
    const ColorImage red(cv::Mat3b(6, 8, cv::Vec3b(200, 10, 20)));
    write("rgb/a.png", encode_png(red));
    const std::vector<std::uint8_t> jpeg = encode_jpeg(red, 95);
    write("rgb/b.jpg", std::string(jpeg.begin(), jpeg.end()));
    write("depth/a.png", encode_depth_png(DepthImage(cv::Mat1f(6, 8, 1.5F)), 1000));
    write("depth/b.png", encode_depth_png(DepthImage(cv::Mat1f(6, 8, 2.5F)), 1000));
  }

  void write(const std::string& name, std::string_view bytes) const {
    write_file_atomically(folder_ / name, bytes);
  }

  [[nodiscard]] std::string open_error() const {
    return error_of([&] { (void)Sequence::open(folder_); });
  }

  [[nodiscard]] std::string read_error() const {
    return error_of([&] { (void)Sequence::open(folder_).read(FrameId(0)); });
  }

  TemporaryFolder base_;
  fs::path folder_;
};

TEST_F(SequenceTest, ReadsFrames) {
  const Sequence sequence = Sequence::open(folder_);
  EXPECT_EQ(sequence.name(), "sequence");
  EXPECT_EQ(sequence.camera().name, "small");
  ASSERT_EQ(sequence.size(), 2U);
  EXPECT_EQ(sequence.entry(FrameId(1)).color_file, folder_ / "rgb/b.jpg");
  EXPECT_FALSE(sequence.groundtruth());
  EXPECT_EQ(sequence.format(), "tum");

  const FramePtr frame = sequence.read(FrameId(0));
  EXPECT_EQ(frame->id, FrameId(0));
  EXPECT_EQ(frame->stamp.text, "10.000");
  EXPECT_EQ(frame->stamp.seconds, 10.0);
  EXPECT_EQ(frame->depth_stamp_s, 10.005);
  EXPECT_EQ(frame->color.mat(5, 7), cv::Vec3b(200, 10, 20));
  EXPECT_EQ(frame->gray.mat(5, 7), 68);  // 0.299 * 200 + 0.587 * 10 + 0.114 * 20 = 67.95
  EXPECT_EQ(frame->depth.mat(5, 7), 1.5F);
  EXPECT_EQ(sequence.read(FrameId(1))->depth.mat(0, 0), 2.5F);
  EXPECT_THROW((void)sequence.read(FrameId(2)), InternalError);
}

TEST_F(SequenceTest, ReadsFramesInThreads) {
  const Sequence sequence = Sequence::open(folder_);
  std::vector<FramePtr> frames(40);
  {
    std::vector<std::jthread> threads;
    for (std::size_t t = 0; t < 4; ++t) {
      threads.emplace_back([&, t] {
        for (std::size_t i = t; i < frames.size(); i += 4) {
          frames[i] = sequence.read(FrameId(static_cast<std::uint32_t>(i % 2)));
        }
      });
    }
  }
  for (std::size_t i = 0; i < frames.size(); ++i) {
    ASSERT_EQ(frames[i]->id.index(), i % 2);
    ASSERT_EQ(cv::norm(frames[i]->color.mat, frames[i % 2]->color.mat, cv::NORM_INF), 0.0);
    ASSERT_EQ(cv::norm(frames[i]->depth.mat, frames[i % 2]->depth.mat, cv::NORM_INF), 0.0);
  }
}

TEST_F(SequenceTest, PairsTheNearestStampsOnceAndWithin20Milliseconds) {
  write("rgb.txt", "1.000 rgb/a\n1.010 rgb/b\n2.000 rgb/c\n3.000 rgb/d\n");
  write("depth.txt", "0.985 depth/a\n1.008 depth/b\n2.021 depth/c\n3.000 depth/d\n");
  const Sequence sequence = Sequence::open(folder_);
  ASSERT_EQ(sequence.size(), 3U);
  EXPECT_EQ(sequence.entry(FrameId(0)).depth_file, folder_ / "depth/a");
  EXPECT_EQ(sequence.entry(FrameId(1)).depth_file, folder_ / "depth/b");
  EXPECT_EQ(sequence.entry(FrameId(2)).stamp.text, "3.000");
}

TEST_F(SequenceTest, TakesTheAssociationsWhereTheyAre) {
  write("associations.txt",
        "10.0 rgb/a.png 10.095 depth/b.png\n10.100000 rgb/b.jpg 10.095 depth/b.png\n");
  const Sequence sequence = Sequence::open(folder_);
  ASSERT_EQ(sequence.size(), 2U);
  EXPECT_EQ(sequence.entry(FrameId(0)).depth_file, folder_ / "depth/b.png");
  EXPECT_EQ(sequence.entry(FrameId(0)).depth_stamp_s, 10.095);
  EXPECT_EQ(sequence.entry(FrameId(0)).stamp.text, "10.000");  // as rgb.txt writes it
  EXPECT_EQ(sequence.entry(FrameId(1)).stamp.text, "10.10");
}

TEST_F(SequenceTest, ChoosesTheCamera) {
  SequenceOptions options;
  options.camera = builtin_camera("bonn");
  EXPECT_EQ(Sequence::open(folder_, options).camera().name, "bonn");
  EXPECT_EQ(Sequence::open(folder_).camera().name, "small");

  fs::create_directories(folder_ / "truth");
  write("truth/objects.json", R"({"camera":{"width":8,"height":6,"fx":9,"fy":9,"cx":4,"cy":3}})");
  fs::remove(folder_ / "camera.yaml");
  EXPECT_EQ(Sequence::open(folder_).camera().fx, 9.0);
  fs::remove_all(folder_ / "truth");
  EXPECT_THAT(open_error(), HasSubstr("put a camera.yaml there"));
  fs::create_directories(folder_ / "truth");
  write("truth/objects.json", R"({"camera":{"width":8,"height":6,"fx":9,"fy":9,"cx":4,"cy":3}})");
  for (const auto& [name, camera] : {std::pair("rgbd_dataset_freiburg1_xyz", "tum_fr1"),
                                     std::pair("TUM-FR2-desk", "tum_fr2"),
                                     std::pair("freiburg3_walking", "tum_fr3"),
                                     std::pair("rgbd_bonn_crowd", "bonn"),
                                     std::pair("fr12_bonnet", "truth")}) {
    fs::rename(folder_, base_.path() / name);
    EXPECT_EQ(Sequence::open(base_.path() / name / "").camera().name, camera) << name;
    fs::rename(base_.path() / name, folder_);
  }
}

TEST_F(SequenceTest, ReadsTheGroundTruthOrSaysWhyNot) {
  write("groundtruth.txt",
        "10.0 1 2 3 0 0 0 1\n10.05 nan nan nan nan nan nan nan\n10.1 4 5 6 0 0 0 1\n");
  GroundTruth truth = Sequence::open(folder_).groundtruth().value();
  ASSERT_EQ(truth.poses.size(), 2U);
  EXPECT_EQ(truth.poses[1].T_world_camera.translation(), Eigen::Vector3d(4, 5, 6));
  EXPECT_THAT(truth.warnings, ElementsAre(HasSubstr("groundtruth.txt: 1 rows without a finite")));
  for (const auto& [text, problem] : {std::pair("", "no poses in the file"),
                                      std::pair("10.0 1 2 3 0 0 0 1\n10.1 4 5", "txt:2: 3 columns"),
                                      std::pair("10.0 1 2 3 0 0 0 0\n", "quaternion")}) {
    write("groundtruth.txt", text);
    truth = Sequence::open(folder_).groundtruth().value();
    EXPECT_TRUE(truth.poses.empty());
    EXPECT_THAT(truth.warnings, ElementsAre(HasSubstr(problem)));
  }
}

TEST_F(SequenceTest, LeavesOutRepeatedStampsAndCountsThem) {
  write("rgb.txt", "10.0 rgb/a.png\n10.0 rgb/b.jpg\n10.1 rgb/b.jpg\n");
  const Sequence sequence = Sequence::open(folder_);
  ASSERT_EQ(sequence.size(), 2U);
  EXPECT_EQ(sequence.entry(FrameId(0)).color_file, folder_ / "rgb/a.png");
  EXPECT_EQ(sequence.entry(FrameId(1)).stamp.text, "10.1");
  EXPECT_THAT(sequence.remarks().warnings, ElementsAre(HasSubstr("rgb.txt: 1 rows repeat")));
}

TEST_F(SequenceTest, SaysWhatItLeftOutAndHowFarTheStreamsAreApart) {
  write("rgb.txt", "1.000 rgb/a\n2.000 rgb/b\n3.000 rgb/c\n4.0 rgb/d\n");
  write("depth.txt", "1.012 depth/a\n2.012 depth/b\n3.021 depth/c\n");
  const Sequence sequence = Sequence::open(folder_);
  EXPECT_EQ(sequence.size(), 2U);
  EXPECT_THAT(sequence.remarks().notes,
              ElementsAre(HasSubstr("2 of 4 colour images have no depth image within 0.02 s"),
                          "depth images are 12.0 ms after colour images (median)"));
  write("depth.txt", "0.75 depth/a\n1.75 depth/b\n2.75 depth/c\n3.75 depth/c\n");
  EXPECT_THAT(open_error(), HasSubstr("depth images are 250.0 ms before colour images"));
}

// The frames of the folder, with the stamps of other units.
TEST_F(SequenceTest, NoticesTheUnitOfStampsAndKeepsTheirTexts) {
  struct Case {
    const char* first;
    const char* second;
    double first_s, second_s;
    const char* note;
  };
  for (const Case& c : {Case{"1403636579763555584",
                             "1403636579813555456",
                             1403636579.763555584,
                             1403636579.813555456,
                             "nanoseconds"},
                        Case{"1403636579763555",
                             "1403636579813555",
                             1403636579.763555,
                             1403636579.813555,
                             "microseconds"},
                        Case{"1403636579763.5",
                             "1403636579813.25",
                             1403636579.7635,
                             1403636579.81325,
                             "milliseconds"},
                        Case{"33", "67", 0.033, 0.067, "milliseconds"},
                        Case{"1", "4", 1 / 30.0, 4 / 30.0, "frame numbers, at 30 Hz"}}) {
    for (const char* list : {"rgb", "depth"}) {
      write(fmt::format("{}.txt", list),
            fmt::format("{0} {2}/a.png\n{1} {2}/b.png\n", c.first, c.second, list));
    }
    write("groundtruth.txt",
          fmt::format("{} 1 2 3 0 0 0 1\n{} 4 5 6 0 0 0 1\n", c.first, c.second));
    const Sequence sequence = Sequence::open(folder_);
    ASSERT_EQ(sequence.size(), 2U) << c.first;
    EXPECT_EQ(sequence.entry(FrameId(1)).stamp.text, c.second);
    EXPECT_NEAR(sequence.entry(FrameId(0)).stamp.seconds, c.first_s, 3e-7);
    EXPECT_NEAR(sequence.entry(FrameId(1)).stamp.seconds, c.second_s, 3e-7);
    EXPECT_NEAR(sequence.entry(FrameId(1)).depth_stamp_s, c.second_s, 3e-7);
    EXPECT_THAT(sequence.remarks().notes,
                ElementsAre(fmt::format("rgb.txt: stamps are {}", c.note),
                            fmt::format("depth.txt: stamps are {}", c.note)));
    const GroundTruth truth = sequence.groundtruth().value();
    ASSERT_EQ(truth.poses.size(), 2U);
    EXPECT_NEAR(truth.poses[1].stamp.seconds, c.second_s, 3e-7);
  }
  SequenceOptions options;
  options.reading.stamp_unit = StampUnit::kSeconds;
  EXPECT_EQ(Sequence::open(folder_, options).entry(FrameId(1)).stamp.seconds, 4.0);
  options.reading = {.rate_hz = 10};
  EXPECT_EQ(Sequence::open(folder_, options).entry(FrameId(1)).stamp.seconds, 0.4);
}

TEST_F(SequenceTest, ReadsTheListsOfWindows) {
  write("rgb.txt",
        "\xEF\xBB\xBF"
        "10.000 rgb\\a.png\r\n10.10 rgb\\b.jpg\r\n");
  std::string utf16 = "\xFF\xFE";
  for (const char c : std::string_view("10.005 depth\\a.png\r\n10.095 depth\\b.png\r\n")) {
    utf16 += {c, '\0'};
  }
  write("depth.txt", utf16);
  const Sequence sequence = Sequence::open(folder_);
  ASSERT_EQ(sequence.size(), 2U);
  EXPECT_EQ(sequence.read(FrameId(1))->depth.mat(0, 0), 2.5F);
}

TEST_F(SequenceTest, ReadsNamesWithBlanksAndAbsoluteNames) {
  fs::rename(folder_ / "rgb/a.png", folder_ / "rgb/first 1 picture.png");
  fs::rename(folder_ / "rgb/b.jpg", base_.path() / "outside.jpg");
  write("rgb.txt",
        fmt::format("10.0 rgb/first 1 picture.png\n10.1 {}\n",
                    (base_.path() / "outside.jpg").string()));
  write("depth.txt", "10.0 /home/other/sequence/depth/a.png\n10.1 \"depth/b.png\"\n");
  const Sequence sequence = Sequence::open(folder_);
  ASSERT_EQ(sequence.size(), 2U);
  EXPECT_EQ(sequence.read(FrameId(0))->depth.mat(0, 0), 1.5F);
  EXPECT_EQ(sequence.read(FrameId(1))->color.mat.cols, 8);
}

// The two frames, from each kind of list of pairs.
TEST_F(SequenceTest, ReadsListsOfPairsAlone) {
  const std::vector<std::string> rows = {
      "10.0 rgb/a.png 10.005 depth/a.png\n10.1 rgb/b.jpg 10.095 depth/b.png\n",
      "10.005 depth/a.png 10.0 rgb/a.png\n10.095 depth/b.png 10.1 rgb/b.jpg\n",
      "10.0 rgb/a.png depth/a.png\n10.1 rgb/b.jpg depth/b.png\n",
      "depth/a.png rgb/a.png\ndepth/b.png rgb/b.jpg\n",
      "10.0 rgb/a.png 10.0 depth/a.png 10.0 1 2 3 0 0 0 1\n10.1 rgb/b.jpg 10.1 depth/b.png 10.1 1 "
      "2 3 0 0 0 1\n"};
  fs::remove(folder_ / "rgb.txt");
  fs::remove(folder_ / "depth.txt");
  for (const std::string& text : rows) {
    write("associations.txt", text);
    const Sequence sequence = Sequence::open(folder_);
    ASSERT_EQ(sequence.size(), 2U) << text;
    EXPECT_EQ(sequence.entry(FrameId(1)).color_file, folder_ / "rgb/b.jpg") << text;
    EXPECT_EQ(sequence.read(FrameId(1))->depth.mat(0, 0), 2.5F) << text;
    const bool counted = !text.starts_with("10");
    EXPECT_EQ(sequence.entry(FrameId(1)).stamp.seconds, counted ? 1 / 30.0 : 10.1) << text;
  }
  fs::rename(folder_ / "rgb/a.png", folder_ / "rgb/00.png");
  fs::rename(folder_ / "rgb/b.jpg", folder_ / "rgb/20.jpg");
  write("associations.txt", "rgb/00.png depth/a.png\nrgb/20.jpg depth/b.png\n");
  EXPECT_EQ(Sequence::open(folder_).entry(FrameId(1)).stamp.seconds, 20 / 30.0);
  EXPECT_EQ(Sequence::open(folder_).entry(FrameId(1)).stamp.text, "0.666667");
  fs::rename(folder_ / "associations.txt", folder_ / "associate.txt");
  EXPECT_EQ(Sequence::open(folder_).size(), 2U);
  write("associate.txt", "10.0 rgb/a.png\n");
  EXPECT_THAT(open_error(), HasSubstr("associate.txt:1: 1 images, expected 2"));
}

TEST_F(SequenceTest, SaysWhatItLookedFor) {
  fs::create_directories(base_.path() / "empty");
  const std::string error = error_of([&] { (void)Sequence::open(base_.path() / "empty"); });
  for (const SequenceFormat& format : folder_formats()) {
    EXPECT_THAT(error, HasSubstr(std::string(format.looks)));
  }
  EXPECT_THAT(error_of([&] { (void)Sequence::open(folder_, {.format = "tun"}); }),
              HasSubstr("tun: unknown format: did you mean 'tum'?"));
  fs::remove(folder_ / "rgb.txt");
  EXPECT_THAT(error_of([&] { (void)Sequence::open(folder_, {.format = "images"}); }),
              HasSubstr("a name of a colour image has no number"));
}

TEST_F(SequenceTest, RefusesBadLists) {
  EXPECT_THAT(error_of([&] { (void)Sequence::open(base_.path() / "none"); }),
              HasSubstr("none: no such file or folder"));
  write("rgb.txt", "# nothing\n");
  EXPECT_THAT(open_error(), HasSubstr("rgb.txt: the list is empty"));
  write("rgb.txt", "10.0 rgb/a.png\n9.0 rgb/b.jpg\n");
  EXPECT_THAT(open_error(), AllOf(HasSubstr("rgb.txt:2"), HasSubstr("9.0 does not come after")));
  write("rgb.txt", "nan rgb/a.png\n");
  EXPECT_THAT(open_error(), HasSubstr("rgb.txt:1: column 1 is 'nan'"));
  write("rgb.txt", "1e400 rgb/a.png\n");
  EXPECT_THAT(open_error(), HasSubstr("column 1 is '1e400'"));
  write("rgb.txt", "../x rgb/a.png\n");
  EXPECT_THAT(open_error(), HasSubstr("finite number"));
  write("rgb.txt", "10.0\n");
  EXPECT_THAT(open_error(), HasSubstr("1 columns, expected 2"));
  write("rgb.txt", "20.0 rgb/a.png\n");
  EXPECT_THAT(open_error(), HasSubstr("within 0.02 s"));
  fs::remove(folder_ / "rgb.txt");
  EXPECT_THAT(open_error(), HasSubstr("rgb.txt is missing"));
}

TEST_F(SequenceTest, RefusesFilesOutsideOfTheFolder) {
  for (const char* file : {"/etc/passwd", "../x.png", "rgb/../../x.png", "rgb/.."}) {
    write("rgb.txt", fmt::format("10.0 rgb/a.png\n10.1 {}\n", file));
    EXPECT_THAT(open_error(), AllOf(HasSubstr("rgb.txt:2"), HasSubstr("out of the sequence")));
  }
  write("rgb.txt", "10.0 rgb/a..b.png\n");
  EXPECT_EQ(Sequence::open(folder_).size(), 1U);
  write("associations.txt", "10.0 rgb/a.png 10.0 /dev/zero\n");
  EXPECT_THAT(open_error(), AllOf(HasSubstr("associations.txt:1"), HasSubstr("/dev/zero")));
}

TEST_F(SequenceTest, RefusesBadImages) {
  write("rgb/a.png", encode_png(ColorImage(cv::Mat3b(6, 9, cv::Vec3b(1, 2, 3)))));
  EXPECT_THAT(read_error(),
              AllOf(HasSubstr("a.png: 9x6 pixels, expected 8x6"), HasSubstr("small")));
  write("rgb/a.png", "junk");
  EXPECT_THAT(read_error(), HasSubstr("rgb/a.png"));
  fs::remove(folder_ / "rgb/a.png");
  EXPECT_THAT(read_error(), HasSubstr("rgb/a.png"));
  write("rgb/a.png", encode_png(ColorImage(cv::Mat3b(6, 8, cv::Vec3b(1, 2, 3)))));
  write("depth/a.png", encode_png(ColorImage(cv::Mat3b(6, 8, cv::Vec3b(1, 2, 3)))));
  EXPECT_THAT(read_error(), AllOf(HasSubstr("depth/a.png"), HasSubstr("16-bit")));
}

TEST(SequenceOnData, OpensTheSharedSequences) {
  STILLMAP_NEED_SHARED_DATA("twin_walking_xyz");
  const fs::path data = shared_data("");
  const Sequence twin = Sequence::open(data / "twin_walking_xyz");
  EXPECT_EQ(twin.size(), 300U);
  EXPECT_EQ(twin.camera().fx, 535.4);
  const Sequence walkers = Sequence::open(data / "fr1_xyz_walkers");
  EXPECT_EQ(walkers.size(), 358U);
  EXPECT_EQ(walkers.camera().name, "tum_fr1");
  const Sequence fr1 = Sequence::open(data / "tum_fr1_xyz_360");
  EXPECT_GT(fr1.size(), 300U);
  const FramePtr frame = fr1.read(FrameId(0));
  EXPECT_EQ(frame->stamp.text, "1305031102.175304");
  EXPECT_EQ(frame->depth.mat.cols, 640);
}

}  // namespace
}  // namespace stillmap
