// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/segmentation/mask_folder.hpp"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "stillmap/io/atomic_file.hpp"
#include "stillmap/io/image_io.hpp"
#include "tests/support/files.hpp"

namespace stillmap {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

const cv::Size kImage(64, 48);
const Stamp kStamp{2.5, "2.50"};

class MaskFolders : public testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path path(const std::string& name) const {
    return folder_.path() / name;
  }
  void write(const std::string& name, const cv::Mat1b& mask) const {
    write_file_atomically(path(name), encode_mask_png(mask));
  }
  [[nodiscard]] FrameDetections read(const std::map<std::string, std::string>& names = {}) const {
    return MaskFolder(folder_.path(), kImage, names).segment(ColorImage(), kStamp);
  }
  [[nodiscard]] std::string refusal() const {
    return error_of([&] { (void)read(); });
  }

  TemporaryFolder folder_;
};

cv::Mat1b mask_with(std::initializer_list<cv::Rect> regions, int value = 255) {
  cv::Mat1b mask = cv::Mat1b::zeros(kImage);
  for (const cv::Rect& region : regions) mask(region).setTo(value);
  return mask;
}

TEST_F(MaskFolders, EachConnectedRegionIsAPerson) {
  for (const int person : {255, 1}) {
    // The last is a speckle of 49 pixels.
    write("2.50.png", mask_with({{2, 3, 10, 20}, {30, 5, 20, 40}, {55, 2, 7, 7}}, person));
    const FrameDetections found = read();
    EXPECT_EQ(found.stamp.text, "2.50");
    ASSERT_EQ(found.objects.size(), 2U);
    EXPECT_EQ(found.objects[0], (DetectedObject{1, "person", 1.0F, {2, 3, 12, 23}}));
    EXPECT_EQ(found.objects[1], (DetectedObject{2, "person", 1.0F, {30, 5, 50, 45}}));
    cv::Mat1b expected = mask_with({{2, 3, 10, 20}}, 1);
    expected(cv::Rect(30, 5, 20, 40)).setTo(2);
    EXPECT_EQ(cv::countNonZero(found.mask.mat != expected), 0);
  }
}

TEST_F(MaskFolders, NobodyIsAMaskOfZeros) {
  write("2.50.png", mask_with({}));
  EXPECT_TRUE(read().objects.empty());
}

TEST_F(MaskFolders, AreNamedAsTheImageOrItsStamp) {
  write("2.50.png", mask_with({{2, 3, 10, 20}}));
  const std::map<std::string, std::string> names = {{"2.50", "frame_0001"}};
  EXPECT_EQ(read(names).objects.size(), 1U);
  write("frame_0001.png", mask_with({{2, 3, 10, 20}, {30, 5, 20, 40}}));
  EXPECT_EQ(read(names).objects.size(), 2U);
  EXPECT_EQ(read().objects.size(), 1U);
}

TEST_F(MaskFolders, MissingOnesAreRefused) {
  EXPECT_THAT(refusal(), AllOf(StartsWith(folder_.path().string()), HasSubstr("no PNG in it")));
  write("other.png", mask_with({}));
  EXPECT_THAT(refusal(), StartsWith(path("2.50.png").string() + ": no such mask"));
  EXPECT_THAT(error_of([] { (void)MaskFolder("/nowhere/masks", kImage, {}); }),
              HasSubstr("expected a folder of masks"));
}

TEST_F(MaskFolders, WrongOnesAreRefused) {
  const std::string file = path("2.50.png").string();
  write("2.50.png", cv::Mat1b::zeros(64, 48));
  EXPECT_EQ(refusal(), file + ": 48x64 pixels, expected 64x48 as the images have");
  cv::Mat1b ids = mask_with({{2, 3, 10, 20}}, 1);
  ids(40, 40) = 2;
  write("2.50.png", ids);
  EXPECT_THAT(refusal(), StartsWith(file + ": has the values 0, 1 and 2, expected 0 for"));
  const std::string whole = encode_mask_png(mask_with({{2, 3, 10, 20}}));
  for (const std::size_t size : {std::size_t{0}, std::size_t{20}, whole.size() / 2}) {
    write_file_atomically(path("2.50.png"), whole.substr(0, size));
    EXPECT_THAT(refusal(), StartsWith(file + ": ")) << size;
  }
  write_file_atomically(path("2.50.png"), encode_png(ColorImage(cv::Mat3b::zeros(kImage))));
  EXPECT_THAT(refusal(), StartsWith(file + ": "));
}

}  // namespace
}  // namespace stillmap
