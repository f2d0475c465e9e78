// SPDX-License-Identifier: Apache-2.0
// Recordings of OpenNI: those that its library writes of its device without hardware, and others
// that are put together here by the same records.
#include "tooling/recordings/oni.hpp"

#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "stillmap/io/atomic_file.hpp"
#include "stillmap/io/image_io.hpp"
#include "stillmap/sensor/sequence_stream.hpp"
#include "tests/support/files.hpp"
#include "tests/support/oni_writer.hpp"
#include "tests/support/plane_sequence.hpp"
#include "tooling/recordings/oni_depth.hpp"
#include "tooling/recordings/recording_formats.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::HasSubstr;

std::string_view bytes_of(const cv::Mat& pixels) {
  return {reinterpret_cast<const char*>(pixels.data), pixels.total() * pixels.elemSize()};
}

TEST(OniDepth, IsThatWhichWasEncoded) {
  std::mt19937 rng(3);
  for (const int most : {1, 5, 40, 500, 32767}) {
    cv::Mat1w units(30, 41);
    int value = 1000;
    for (std::uint16_t& unit : units) {
      if (rng() % 3 != 0)
        value += static_cast<int>(rng() % (2U * static_cast<unsigned>(most) + 1)) - most;
      value = std::clamp(value, 0, 32767);
      unit = static_cast<std::uint16_t>(rng() % 20 == 0 ? 0 : value);
    }
    for (const bool with_table : {false, true}) {
      const std::string bytes = encode_oni_depth(units, with_table);
      const std::string codec = with_table ? "16zT" : "16zP";
      EXPECT_EQ(cv::norm(decode_oni_depth(bytes, codec, units.size(), "d"), units, cv::NORM_INF),
                0);
      EXPECT_THROW((void)decode_oni_depth(bytes, codec, {41, 31}, "d"), DamagedImage);
      EXPECT_THROW((void)decode_oni_depth(bytes, codec, {41, 29}, "d"), DamagedImage);
      EXPECT_THROW(
          (void)decode_oni_depth(bytes.substr(0, bytes.size() / 2), codec, units.size(), "d"),
          DamagedImage);
    }
    EXPECT_EQ(
        cv::norm(decode_oni_depth(bytes_of(units), "NONE", units.size(), "d"), units, cv::NORM_INF),
        0);
  }
  EXPECT_THAT(error_of([] {
                (void)decode_oni_depth("", "XYZ1", {2, 2}, "d");
              }),
              HasSubstr("codec 'XYZ1', expected NONE, 16zT or 16zP"));
  EXPECT_THROW((void)decode_oni_depth("", "16zT", {2, 2}, "d"), DamagedImage);
  const std::string no_table(4, '\0');
  EXPECT_THROW((void)decode_oni_depth(no_table, "16zT", {1, 1}, "d"), DamagedImage);
}

// An image as the recorder of OpenNI 2.2 stored it: of its device without hardware, "Dummy", which
// shows a row of 2 m above some ramps. The sums are those of the pixels that the library
// gave for it. (The recorder itself is not called here: with "Dummy" it hangs now and then.)
TEST(OniDepth, IsThatOfOpenNisLibrary) {
  // Bytes, and how often 0xEF follows them.
  const std::vector<std::pair<std::string_view, std::size_t>> parts = {
      {"12000000d003d303d603d903dc03df03e203e503e803eb03ee03f103f403f703fa03fd03d0071100", 10},
      {"e96fc955555555ffd0", 10},
      {"e5ffb955555555ffcf", 10},
      {"e505555555ffcd", 10},
      {"e5615555555fcc", 10},
      {"e562555555ffca", 10},
      {"e6355555ffc8", 10},
      {"e6645555c6", 10},
      {"e6655596", 2474},
      {"6de7", 0}};
  std::string bytes;
  for (const auto& [hex, runs] : parts) {
    for (std::size_t i = 0; i < hex.size(); i += 2) {
      bytes += static_cast<char>(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16));
    }
    bytes += std::string(runs, '\xEF');
  }
  const cv::Mat1w units = decode_oni_depth(bytes, "16zT", {320, 240}, "d");
  std::uint64_t sum = 0, weighted = 0, position = 0;
  for (const std::uint16_t unit : units) {
    sum += unit;
    weighted += unit * ++position;
  }
  EXPECT_EQ(cv::countNonZero(units), 375);
  EXPECT_EQ(sum, 694892U);
  EXPECT_EQ(weighted, 170651920U);
}

class OniRecording : public testing::Test {
 protected:
  OniRecording() {
    write_plane_sequence(base_.path() / "wall", kFrames);
    wall_ = Sequence::open(base_.path() / "wall");
  }

  [[nodiscard]] FramePtr frame(std::uint32_t i) const { return wall_->read(FrameId(i)); }
  [[nodiscard]] cv::Mat1w millimetres(std::uint32_t i) const {
    cv::Mat1w units;
    frame(i)->depth.mat.convertTo(units, CV_16U, 1000);
    return units;
  }
  [[nodiscard]] static std::uint64_t stamp_us(std::uint32_t i) { return 5000 + 33333 * i; }
  [[nodiscard]] fs::path path() const { return base_.path() / "wall.oni"; }
  [[nodiscard]] Sequence open() const {
    return Sequence::open(path(), {.formats = recording_formats()});
  }

  // A recording of the wall with the field of view of its camera.
  [[nodiscard]] OniWriter begun(const char* color, const char* depth) const {
    OniWriter writer;
    const CameraModel& camera = wall_->camera();
    writer.add_stream(1, OniWriter::kColor, color, {320, 240});
    writer.add_stream(2, OniWriter::kDepth, depth, {320, 240});
    writer.field_of_view(1, 2 * std::atan(160 / camera.fx), 2 * std::atan(120 / camera.fy));
    return writer;
  }

  void expect_wall(const Sequence& sequence) const {
    EXPECT_EQ(sequence.format(), "oni");
    EXPECT_NEAR(sequence.camera().fx, wall_->camera().fx, 1e-9);
    EXPECT_EQ(sequence.camera().cx, 159.5);
    ASSERT_EQ(sequence.size(), wall_->size());
    for (std::uint32_t i = 0; i < sequence.size(); ++i) {
      const FramePtr read = sequence.read(FrameId(i));
      EXPECT_NEAR(read->stamp.seconds, 1e-6 * static_cast<double>(stamp_us(i)), 1e-9);
      EXPECT_EQ(cv::norm(read->color.mat, frame(i)->color.mat, cv::NORM_INF), 0);
      EXPECT_EQ(cv::norm(read->depth.mat, frame(i)->depth.mat, cv::NORM_INF), 0);
    }
  }

  static constexpr int kFrames = 4;
  TemporaryFolder base_;
  std::optional<Sequence> wall_;
};

TEST_F(OniRecording, GivesTheBitsOfTheFolder) {
  for (const char* codec : {"NONE", "16zT", "16zP"}) {
    OniWriter writer = begun("NONE", codec);
    for (std::uint32_t i = 0; i < kFrames; ++i) {
      const std::string coded = codec == std::string("NONE")
                                    ? std::string(bytes_of(millimetres(i)))
                                    : encode_oni_depth(millimetres(i), codec[3] == 'T');
      writer.image(2, stamp_us(i), coded);
      writer.image(1, stamp_us(i), bytes_of(frame(i)->color.mat));
    }
    writer.end();
    write_file_atomically(path(), writer.bytes());
    expect_wall(open());
    EXPECT_TRUE(open().remarks().warnings.empty());
  }
}

TEST_F(OniRecording, MayBeMirroredAndInTenthsOfMillimetres) {
  OniWriter writer = begun("NONE", "NONE");
  for (const std::uint32_t node : {1U, 2U}) writer.integer(node, "xnMirror", 1);
  writer.integer(2, "oniPixelFormat", 101);
  for (std::uint32_t i = 0; i < kFrames; ++i) {
    cv::Mat3b color;
    cv::Mat1w units;
    cv::flip(frame(i)->color.mat, color, 1);
    cv::flip(millimetres(i) * 10, units, 1);
    writer.image(1, stamp_us(i), bytes_of(color));
    writer.image(2, stamp_us(i), bytes_of(units));
  }
  write_file_atomically(path(), writer.bytes());
  expect_wall(open());
}

TEST_F(OniRecording, OfWhichTheEndIsMissingHasWhatIsThere) {
  OniWriter writer = begun("JPEG", "16zT");
  for (std::uint32_t i = 0; i < kFrames; ++i) {
    const std::vector<std::uint8_t> jpeg = encode_jpeg(frame(i)->color, 95);
    writer.image(1, stamp_us(i), std::string(jpeg.begin(), jpeg.end()));
    writer.image(2, stamp_us(i), encode_oni_depth(millimetres(i), true));
  }
  write_file_atomically(path(), writer.bytes().substr(0, writer.bytes().size() - 5));
  const Sequence sequence = open();
  EXPECT_EQ(sequence.size(), 3U);
  EXPECT_THAT(sequence.remarks().warnings, Contains(HasSubstr("are no whole record")));
  EXPECT_LT(cv::norm(sequence.read(FrameId(1))->color.mat, frame(1)->color.mat, cv::NORM_INF), 60);
}

TEST_F(OniRecording, LeavesImagesOutThatRepeatAStamp) {
  OniWriter writer = begun("NONE", "NONE");
  for (const std::uint64_t stamp : {std::uint64_t{0}, std::uint64_t{1} << 63U}) {
    for (std::uint64_t i = 0; i < 2; ++i) {  // the same in seconds
      writer.image(1, stamp + (stamp > 0 ? i : 0), bytes_of(frame(0)->color.mat));
      writer.image(2, stamp, bytes_of(millimetres(0)));
    }
  }
  write_file_atomically(path(), writer.bytes());
  EXPECT_EQ(open().size(), 2U);
  EXPECT_THAT(open().remarks().warnings,
              Contains("Image: 2 images have the stamp of another and are left out"));
}

TEST_F(OniRecording, SaysWhatIsMissing) {
  const auto error = [&](const std::string& bytes) {
    write_file_atomically(path(), bytes);
    return error_of([&] { (void)open(); });
  };
  OniWriter writer = begun("NONE", "NONE");
  EXPECT_THAT(error(writer.bytes()), HasSubstr("wall.oni: has no colour images"));
  writer.image(1, 0, bytes_of(frame(0)->color.mat));
  EXPECT_THAT(error(writer.bytes()), HasSubstr("wall.oni: has no depth images"));
  OniWriter unequal;
  unequal.add_stream(1, OniWriter::kColor, "NONE", {640, 480});
  unequal.add_stream(2, OniWriter::kDepth, "NONE", {320, 240});
  for (const std::uint32_t node : {1U, 2U}) unequal.image(node, 0, "x");
  EXPECT_THAT(error(unequal.bytes()), HasSubstr("depth of 320x240 pixels, but colour of 640x480"));
  OniWriter blind;
  blind.add_stream(1, OniWriter::kColor, "NONE", {320, 240});
  blind.add_stream(2, OniWriter::kDepth, "NONE", {320, 240});
  for (const std::uint32_t node : {1U, 2U}) blind.image(node, 0, "x");
  EXPECT_THAT(error(blind.bytes()), HasSubstr("tells no field of view"));
  write_file_atomically(path(), blind.bytes());
  const Sequence damaged =
      Sequence::open(path(), {.camera = wall_->camera(), .formats = recording_formats()});
  EXPECT_THROW((void)damaged.read(FrameId(0)), DamagedImage);
}

TEST_F(OniRecording, SurvivesRandomDamage) {
  OniWriter writer;
  const cv::Mat1w units(6, 8, std::uint16_t{1500});
  writer.add_stream(1, OniWriter::kColor, "NONE", {8, 6});
  writer.add_stream(2, OniWriter::kDepth, "16zT", {8, 6});
  writer.field_of_view(1, 1, 0.8);
  writer.image(1, 0, std::string(8 * 6 * 3, 'x'));
  writer.image(2, 0, encode_oni_depth(units, true));
  std::mt19937 rng(5);
  std::size_t read = 0;
  for (int i = 0; i < 1000; ++i) {
    std::string bytes = writer.bytes();
    for (unsigned changes = 1 + rng() % 3; changes > 0; --changes) {
      bytes[24 + rng() % (bytes.size() - 24)] = static_cast<char>(rng());
    }
    write_file_atomically(path(), bytes);
    try {
      (void)open().read(FrameId(0));
      ++read;
    } catch (const Error&) {
      continue;
    }
  }
  EXPECT_GT(read, 100U);
  EXPECT_LT(read, 900U);
}

}  // namespace
}  // namespace stillmap
