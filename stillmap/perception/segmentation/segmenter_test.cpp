// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/segmentation/segmenter.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <string>
#include <string_view>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "stillmap/io/image_io.hpp"
#include "stillmap/perception/detections/box_overlap.hpp"
#include "stillmap/perception/detections/detections_io.hpp"
#include "stillmap/perception/segmentation/model_folder.hpp"
#include "stillmap/perception/segmentation/onnx_runtime.hpp"
#include "tests/support/files.hpp"
#include "tests/support/onnx_file.hpp"
#include "tests/support/shared_data.hpp"

namespace stillmap {
namespace {

using testing::HasSubstr;

const cv::Size kImage(640, 480);

/// Gives an environment variable another value during its lifetime.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    if (const char* const before = std::getenv(name)) before_ = before;
    ::setenv(name, value.c_str(), 1);
  }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;
  ~Variable() {
    if (before_.empty()) {
      ::unsetenv(name_);
    } else {
      ::setenv(name_, before_.c_str(), 1);
    }
  }

 private:
  const char* name_;
  std::string before_;
};

std::string refusal(const std::string& description) {
  return error_of([&] { (void)make_segmenter(description, kImage); });
}

TEST(MakeSegmenter, NamesWhatItExpects) {
  for (const char* description : {"", "yes", "detections:", "masks:", "onnx:", "Auto", "none"}) {
    EXPECT_THAT(refusal(description),
                HasSubstr("detections:DIR, masks:DIR, onnx:MODEL.onnx or auto"));
  }
}

TEST(MakeSegmenter, NamesWhatIsMissing) {
  const TemporaryFolder folder;
  EXPECT_THAT(refusal("detections:" + folder.path().string()), HasSubstr("detections.jsonl"));
  EXPECT_THAT(refusal("onnx:" + (folder.path() / "no.onnx").string()), HasSubstr("no.onnx: "));
  const Variable models("STILLMAP_MODELS", folder.path().string());
  for (const char* description : {"auto", "onnx:auto"}) {
    EXPECT_THAT(refusal(description),
                testing::AllOf(HasSubstr((folder.path() / "nanodet.onnx").string()),
                               HasSubstr("run tools/fetch_models")));
  }
}

TEST(MakeSegmenter, FolderGivesBackWhatWasWritten) {
  const TemporaryFolder folder;
  FrameDetections written;
  written.stamp = {1.5, "1.5"};
  written.objects.push_back({7, "person", 0.5F, {1, 2, 30, 40}});
  written.mask = ObjectMask(cv::Mat1b::zeros(kImage));
  written.mask.mat(cv::Rect(1, 2, 20, 20)).setTo(7);
  DetectionsWriter writer(folder.path(), kImage);
  writer.add(written);
  writer.finish();
  const std::unique_ptr<Segmenter> segmenter =
      make_segmenter("detections:" + folder.path().string(), kImage);
  const FrameDetections read = segmenter->segment(ColorImage(), {1.5, "1.5"});
  EXPECT_EQ(read.objects, written.objects);
  EXPECT_EQ(cv::countNonZero(read.mask.mat != written.mask.mat), 0);
  EXPECT_THAT(error_of([&] {
                (void)segmenter->segment(ColorImage(), {2, "2"});
              }),
              HasSubstr("stamp 2"));
}

TEST(ModelFolder, FollowsTheEnvironment) {
  {
    const Variable models("STILLMAP_MODELS", "/m");
    EXPECT_EQ(model_folder(), "/m");
    EXPECT_EQ(onnx_runtime_libraries().front(), "/m/libonnxruntime.so.1");
    const Variable library("STILLMAP_ONNXRUNTIME", "/l.so");
    EXPECT_THAT(onnx_runtime_libraries(), testing::ElementsAre("/l.so"));
  }
  const Variable models("STILLMAP_MODELS", "");
  const Variable home("HOME", "/h");
  {
    const Variable data("XDG_DATA_HOME", "/d");
    EXPECT_EQ(model_folder(), "/d/stillmap/models");
  }
  const Variable data("XDG_DATA_HOME", "");
  EXPECT_EQ(model_folder(), "/h/.local/share/stillmap/models");
}

// A network with one input, 1x3xHxW: `sums` over H and W, and `whole`, the same as integers.
constexpr std::string_view kSumsNetwork =
    "080812003ab8010a2f0a05696d6167650a0461786573120473756d73220952656475636553756d2a0f0a086b"
    "65657064696d731800a001020a1e0a0473756d73120577686f6c652204436173742a090a02746f1807a00102"
    "1201672a0e080210073a0202034204617865735a210a05696d61676512180a16080112120a0208010a020803"
    "0a031201680a0312017762160a0473756d73120e0a0c080112080a0208010a02080362170a0577686f6c6512"
    "0e0a0c080712080a0208010a02080342040a00100d72190a056e616d657312107b303a202761272c20313a20"
    "2762277d";

std::string from_hex(std::string_view hex) {
  std::string bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2) {
    bytes += static_cast<char>(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16));
  }
  return bytes;
}

// Tests that run networks: skipped where ONNX Runtime is missing.
class OnnxNetworks : public testing::Test {
 protected:
  void SetUp() override {
    if (!built_with_onnx_runtime()) GTEST_SKIP() << "built without ONNX Runtime: make models";
    write("sums.onnx", from_hex(kSumsNetwork));
    try {
      sums_ = open_onnx_network(path("sums.onnx"), {1});
    } catch (const Error& error) {
      if (!std::string(error.what()).starts_with("ONNX Runtime cannot be loaded")) throw;
      GTEST_SKIP() << error.what();
    }
  }

  [[nodiscard]] std::filesystem::path path(const std::string& name) const {
    return folder_.path() / name;
  }
  void write(const std::string& name, const std::string& bytes) const {
    std::ofstream(path(name), std::ios::binary) << bytes;
  }

  TemporaryFolder folder_;
  std::unique_ptr<Network> sums_;
};

TEST_F(OnnxNetworks, SaysWhatItIs) {
  const NetworkSignature& signature = sums_->signature();
  ASSERT_EQ(signature.inputs.size(), 1U);
  EXPECT_EQ(signature.inputs[0].name, "image");
  EXPECT_THAT(signature.inputs[0].shape, testing::ElementsAre(1, 3, -1, -1));
  ASSERT_EQ(signature.outputs.size(), 2U);
  EXPECT_EQ(signature.outputs[1].name, "whole");
  EXPECT_EQ(signature.class_names, "{0: 'a', 1: 'b'}");
}

TEST_F(OnnxNetworks, Runs) {
  const std::vector<Tensor> outputs = sums_->run({{1, 3, 1, 2}, {1, 2.5F, -1, 0, 10, 100}});
  ASSERT_EQ(outputs.size(), 2U);
  EXPECT_THAT(outputs[0].shape, testing::ElementsAre(1, 3));
  EXPECT_THAT(outputs[0].values, testing::ElementsAre(3.5F, -1, 110));
  EXPECT_THAT(outputs[1].values, testing::ElementsAre(3, -1, 110));
}

TEST_F(OnnxNetworks, FailuresNameTheFile) {
  EXPECT_THAT(error_of([&] {
                (void)sums_->run({{1, 4, 1, 1}, {1, 2, 3, 4}});
              }),
              HasSubstr("sums.onnx: "));
  write("broken.onnx", from_hex(kSumsNetwork).substr(0, 60));
  EXPECT_THAT(refusal("onnx:" + path("broken.onnx").string()),
              testing::AllOf(HasSubstr("broken.onnx: "), HasSubstr("expected an ONNX network")));
  EXPECT_THAT(refusal("onnx:" + path("sums.onnx").string()),
              testing::AllOf(HasSubstr("sums.onnx: "), HasSubstr("expected a class map")));
}

// A network that returns its image has the colours as classes, named red, green and blue.
TEST_F(OnnxNetworks, RunInHalfPrecision) {
  OnnxFile colours{{1, 3, 480, 640}, {{"map", {1, 3, 480, 640}, {}}}};
  colours.metadata = {{"names", "['background', 'person', 'chair']"}};
  cv::Mat3b image(kImage, cv::Vec3b(255, 0, 0));
  image(cv::Rect(100, 50, 60, 80)).setTo(cv::Scalar(0, 255, 0));
  std::vector<FrameDetections> found;
  for (const bool half : {false, true}) {
    colours.half_precision = half;
    write("colours.onnx", colours.bytes());
    found.push_back(make_segmenter("onnx:" + path("colours.onnx").string(), kImage)
                        ->segment(ColorImage(image), {1, "1"}));
    ASSERT_EQ(found.back().objects.size(), 1U);
    EXPECT_EQ(found.back().objects[0].class_name, "person");
    EXPECT_EQ(found.back().objects[0].box, (PixelBox{100, 50, 160, 130}));
  }
  EXPECT_EQ(cv::countNonZero(found[0].mask.mat != found[1].mask.mat), 0);
}

TEST_F(OnnxNetworks, ReadTheTaskOfUltralyticsExports) {
  OnnxFile pose{{1, 3, 64, 64}, {{"output0", {1, 84, 100}, std::vector<float>(8400)}}};
  pose.metadata = {{"task", "pose"}};
  write("pose.onnx", pose.bytes());
  EXPECT_THAT(refusal("onnx:" + path("pose.onnx").string()),
              HasSubstr("pose.onnx: a network for the task 'pose'"));
}

TEST_F(OnnxNetworks, RefuseClassifiersAndLogits) {
  const auto refusal_of = [&](const TensorShape& shape, float value) {
    const auto count = static_cast<std::size_t>(element_count(shape));
    const OnnxFile file{{1, 3, 64, 64}, {{"y", shape, std::vector<float>(count, value)}}};
    write("wrong.onnx", file.bytes());
    return refusal("onnx:" + path("wrong.onnx").string());
  };
  EXPECT_THAT(refusal_of({1, 1000}, 0.5F),
              HasSubstr("wrong.onnx: a network with the output "
                        "1x1000, as image classifiers have"));
  EXPECT_THAT(refusal_of({1, 84, 100}, 4),
              HasSubstr("wrong.onnx: the network's output for an empty image: a score of 4"));
}

class FetchedNetworks : public OnnxNetworks {
 protected:
  void SetUp() override {
    OnnxNetworks::SetUp();
    if (IsSkipped()) return;
    if (!std::filesystem::exists(model_folder() / "selfie.onnx")) {
      GTEST_SKIP() << "no networks in " << model_folder() << ": make models";
    }
    STILLMAP_NEED_SHARED_DATA("photos");
    photos_ = shared_data("photos");
  }

  [[nodiscard]] ColorImage photo(const std::string& stamp) const {
    return read_color(photos_ / ("fr3_walking_halfsphere_" + stamp + ".jpg"));
  }

  std::filesystem::path photos_;
};

// Both people in each of four photographs; the expected boxes were drawn by eye.
TEST_F(FetchedNetworks, FindPeopleInPhotographs) {
  const std::unique_ptr<Segmenter> segmenter = make_segmenter("auto", kImage);
  int found = 0;
  for (const char* stamp :
       {"1341846434.710184", "1341846434.810024", "1341846434.914148", "1341846435.014019"}) {
    const FrameDetections frame = segmenter->segment(photo(stamp), {1, stamp});
    for (const PixelBox& person : {PixelBox{40, 200, 235, 478}, PixelBox{330, 275, 595, 475}}) {
      found += std::ranges::any_of(frame.objects, [&](const DetectedObject& object) {
        return object.class_name == "person" && box_iou(object.box, person) > 0.5 &&
               cv::countNonZero(frame.mask.mat == object.id) > 0.2 * object.box.area();
      });
    }
  }
  EXPECT_GE(found, 7);
}

TEST_F(FetchedNetworks, SameBitsForAnyNumberOfThreads) {
  const ColorImage image = photo("1341846434.710184");
  const FrameDetections one = make_segmenter("auto", kImage, {1})->segment(image, {1, "1"});
  const FrameDetections three = make_segmenter("auto", kImage, {3})->segment(image, {1, "1"});
  EXPECT_FALSE(one.objects.empty());
  EXPECT_EQ(one.objects, three.objects);
  EXPECT_EQ(cv::countNonZero(one.mask.mat != three.mask.mat), 0);
}

}  // namespace
}  // namespace stillmap
