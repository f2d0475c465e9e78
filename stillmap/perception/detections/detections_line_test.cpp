// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/detections/detections_line.hpp"

#include <array>
#include <cstdint>
#include <random>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "stillmap/io/stamp_text.hpp"
#include "stillmap/perception/detections/class_names.hpp"
#include "tests/support/files.hpp"

namespace stillmap {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

const cv::Size kImage(640, 480);

DetectionsLine parse(const std::string& text) {
  return parse_detections_line(text, kImage, "d.jsonl:7");
}

std::string refusal(const std::string& text) {
  const std::string message = error_of([&] { (void)parse(text); });
  EXPECT_THAT(message, StartsWith("d.jsonl:7: ")) << text;
  EXPECT_LT(message.size(), 300U) << text;
  return message;
}

// A line with one object, one member of which is replaced.
std::string with(const std::string& key, const std::string& value) {
  const auto part = [&](const std::string& name, const std::string& usual) {
    return '"' + name + "\":" + (name == key ? value : usual);
  };
  return "{" + part("stamp", "\"12.5\"") + ",\"objects\":[{" + part("id", "3") + "," +
         part("class", "\"person\"") + "," + part("score", "0.75") + "," +
         part("box", "[1,2.5,30,40]") + "}]}";
}

TEST(ParseDetectionsLine, GivesWhatTheLineSays) {
  const DetectionsLine line =
      parse(R"({"stamp":"1341846313.592026","more":{"a":[1]},"objects":[)"
            R"({"id":255,"class":"person","score":0.98,"box":[1,2.5,300,480],"track":9},)"
            R"({"id":1,"class":"tvmonitor","score":1,"box":[-20,-1.25,641,500]}]})");
  EXPECT_EQ(line.stamp.text, "1341846313.592026");
  EXPECT_EQ(line.stamp.seconds, 1341846313.592026);
  const std::vector<DetectedObject> expected = {{255, "person", 0.98F, {1, 2.5, 300, 480}},
                                                {1, "tv", 1.F, {-20, -1.25, 641, 500}}};
  EXPECT_EQ(line.objects, expected);
}

TEST(ParseDetectionsLine, KnowsWhereMasksComeFrom) {
  const std::string text =
      R"({"stamp":"7","objects":[{"id":1,"class":"person","score":0.5,"box":[1,2,30,40],"mask":"rough"},)"
      R"({"id":2,"class":"chair","score":0.5,"box":[1,2,30,40],"mask":"depth"}]})";
  const DetectionsLine line = parse(text);
  ASSERT_EQ(line.objects.size(), 2U);
  EXPECT_EQ(line.objects[0].pixel_source, PixelSource::kRoughNetwork);
  EXPECT_EQ(line.objects[1].pixel_source, PixelSource::kDepth);
  EXPECT_EQ(format_detections_line({line.stamp, line.objects, {}}), text);
  for (const char* other : {R"("precise")", "1", "null"}) {
    EXPECT_THAT(refusal(with("score", R"(0.5,"mask":)" + std::string(other))),
                HasSubstr(R"(object 3: mask is neither "rough" nor "depth")"));
  }
}

TEST(ParseDetectionsLine, TakesAFrameWithoutObjects) {
  EXPECT_TRUE(parse(R"({"stamp":"7","objects":[]})").objects.empty());
  EXPECT_TRUE(parse("{\"stamp\":\"7\",\"objects\":[]}\r").objects.empty());
}

TEST(ParseDetectionsLine, RefusesWhatIsNoJsonObject) {
  for (const char* text : {"",
                           "{",
                           "[]",
                           "null",
                           "17",
                           "{\"stamp\":\"1\",\"objects\":[]} x",
                           "{\"stamp\":\"1\",\"objects\":[NaN]}",
                           "{\"stamp\":\"1\",\"objects\":[1e999]}",
                           "{\"stamp\":\"\xff\",\"objects\":[]}"}) {
    EXPECT_THAT(refusal(text), HasSubstr("no JSON object")) << text;
  }
  EXPECT_THAT(refusal(std::string(500000, '[')), HasSubstr("no JSON object"));
  EXPECT_THAT(refusal(std::string(2000000, ' ')), HasSubstr("longer than"));
}

TEST(ParseDetectionsLine, RefusesWhatIsMissing) {
  EXPECT_THAT(refusal(R"({"objects":[]})"), HasSubstr("no 'stamp'"));
  EXPECT_THAT(refusal(R"({"stamp":"1"})"), HasSubstr("no 'objects'"));
  EXPECT_THAT(refusal(R"({"stamp":"1","objects":{}})"), HasSubstr("no list"));
  EXPECT_THAT(refusal(R"({"stamp":"1","objects":[3]})"), HasSubstr("no object"));
  EXPECT_THAT(refusal(R"({"stamp":"1","objects":[{}]})"), HasSubstr("no 'id'"));
  EXPECT_THAT(refusal(R"({"stamp":"1","objects":[{"id":4}]})"), HasSubstr("object 4: no 'class'"));
}

TEST(ParseDetectionsLine, RefusesStampsThatAreNoNumbers) {
  for (const char* stamp : {"12.5", "-7.25", "1.", "1.3e9", ".5"}) {
    const std::string quoted = '"' + std::string(stamp) + '"';
    EXPECT_EQ(parse(with("stamp", quoted)).stamp.seconds, std::stod(stamp));
    EXPECT_EQ(parse(with("stamp", quoted)).stamp.text, stamp);
  }
  const std::string long_one = '"' + std::string(65, '1') + '"';
  for (const char* stamp : {"12.5",
                            "\"\"",
                            "\"+1\"",
                            "\" 1\"",
                            "\"1 \"",
                            "\"nan\"",
                            "\"inf\"",
                            "\"..\"",
                            "\"1.2.3\"",
                            "\"../1\"",
                            "\"/etc/1\"",
                            "\"1/2\"",
                            "\"0x10\"",
                            "\"1e999\"",
                            long_one.c_str(),
                            "\"1\\u0000\"",
                            "\"1\\n2\"",
                            "null"}) {
    EXPECT_THAT(refusal(with("stamp", stamp)), HasSubstr("stamp")) << stamp;
  }
}

TEST(ParseDetectionsLine, RefusesIdsThatNoPixelCanHave) {
  EXPECT_EQ(parse(with("id", "255")).objects[0].id, 255);
  for (const char* id : {"0",
                         "256",
                         "-1",
                         "1.0",
                         "1.5",
                         "\"1\"",
                         "true",
                         "null",
                         "18446744073709551615",
                         "4294967297",
                         "-9223372036854775808"}) {
    EXPECT_THAT(refusal(with("id", id)), HasSubstr("id is not")) << id;
  }
  std::string twice = with("id", "3");
  const std::string object = twice.substr(twice.find("[{") + 1);
  twice.replace(twice.size() - 2, 2, "," + object);
  EXPECT_THAT(refusal(twice), HasSubstr("id 3 stands twice"));
}

TEST(ParseDetectionsLine, RefusesWrongClassesAndScores) {
  for (const char* name : {"\"\"", "3", "null", "[]", "\"a\\nb\"", "\"\\u0085\"", "\"\\u007f\""}) {
    EXPECT_THAT(refusal(with("class", name)), HasSubstr("object 3: class")) << name;
  }
  EXPECT_THAT(refusal(with("class", '"' + std::string(257, 'a') + '"')), HasSubstr("class"));
  EXPECT_EQ(parse(with("class", '"' + std::string(256, 'a') + '"')).objects.size(), 1U);
  for (const char* name :
       {"caf\xc3\xa9", "Fu\xc3\x9fg\xc3\xa4nger", "\xe4\xba\xba", "\xf0\x9f\x90\x88"}) {
    EXPECT_EQ(parse(with("class", '"' + std::string(name) + '"')).objects[0].class_name, name);
  }
  for (const char* score : {"-0.01", "1.01", "\"0.5\"", "null", "1e300"}) {
    EXPECT_THAT(refusal(with("score", score)), HasSubstr("object 3: score")) << score;
  }
}

TEST(ParseDetectionsLine, RefusesBoxesThatCannotBe) {
  EXPECT_EQ(parse(with("box", "[-640,-480,1280,960]")).objects[0].box.width(), 1920);
  for (const char* box : {"[1,2,3]",
                          "[1,2,3,4,5]",
                          "{}",
                          "null",
                          "[1,2,\"3\",4]",
                          "[1,2,null,4]",
                          "[5,2,3,9]",
                          "[1,9,3,4]",
                          "[3,2,3,4]",
                          "[1,2,3,2]",
                          "[-641,2,3,4]",
                          "[1,-481,3,4]",
                          "[1,2,1281,4]",
                          "[1,2,3,961]",
                          "[1,2,3,1e300]"}) {
    EXPECT_THAT(refusal(with("box", box)), HasSubstr("object 3: box")) << box;
  }
}

TEST(FormatDetectionsLine, IsTheInterfacesLine) {
  FrameDetections frame;
  frame.stamp = {1341846313.592026, "1341846313.592026"};
  EXPECT_EQ(format_detections_line(frame), R"({"stamp":"1341846313.592026","objects":[]})");
  frame.objects = {{1, "person", 0.98F, {10, 20, 30.5, 40}},
                   {2, "dining table", 1.F, {0, 0, 1, 1}}};
  EXPECT_EQ(format_detections_line(frame),
            R"({"stamp":"1341846313.592026","objects":[)"
            R"({"id":1,"class":"person","score":0.98,"box":[10,20,30.5,40]},)"
            R"({"id":2,"class":"dining table","score":1,"box":[0,0,1,1]}]})");
}

TEST(FormatDetectionsLine, KeepsEveryBitAndIsReadByAnotherLibrary) {
  FrameDetections frame;
  frame.stamp = {0.1, "0.1"};
  frame.objects = {{17, "a \"quoted\\ one", 1.F / 3.F, {0.1, 1.0 / 3.0, 1e2 / 7.0, 1e-7 + 2.0}}};
  const std::string text = format_detections_line(frame);
  EXPECT_EQ(parse(text).objects, frame.objects);
  const nlohmann::json object = nlohmann::json::parse(text).at("objects").at(0);
  EXPECT_EQ(object.at("class"), "a \"quoted\\ one");
  EXPECT_EQ(object.at("box").at(1), 1.0 / 3.0);
  EXPECT_EQ(object.at("score").get<float>(), 1.F / 3.F);
}

// A text of random characters of all planes of Unicode, control characters excepted.
std::string random_class_name(std::mt19937& rng) {
  std::string name;
  const std::size_t length = 1 + rng() % 60;
  while (name.size() < length) {
    static constexpr std::array<std::uint32_t, 4> kBeyond = {0x7F, 0x800, 0xD800, 0x110000};
    static constexpr std::array<std::uint32_t, 4> kFrom = {0x20, 0xA0, 0x800, 0x10000};
    const std::size_t plane = rng() % 4;
    const std::uint32_t code = kFrom.at(plane) + rng() % (kBeyond.at(plane) - kFrom.at(plane));
    const auto tail = [&](unsigned shift) {
      return static_cast<char>(0x80U | ((code >> shift) & 0x3FU));
    };
    if (plane == 0) name += static_cast<char>(code);
    if (plane == 1) name += {static_cast<char>(0xC0U | (code >> 6U)), tail(0)};
    if (plane == 2) name += {static_cast<char>(0xE0U | (code >> 12U)), tail(6), tail(0)};
    if (plane == 3) name += {static_cast<char>(0xF0U | (code >> 18U)), tail(12), tail(6), tail(0)};
  }
  return name;
}

// Whatever can be written is read again as it was.
TEST(FormatDetectionsLine, IsReadAgain) {
  std::mt19937 rng(3);
  for (int i = 0; i < 3000; ++i) {
    FrameDetections frame;
    const std::array<std::string, 5> stamps = {fmt::format("{}", rng()),
                                               fmt::format("{}.", rng()),
                                               fmt::format("-{:.3f}", rng() / 7.0),
                                               fmt::format("{:.9e}", rng() * 1e9),
                                               fmt::format("{:.6f}", rng() / 3.0)};
    frame.stamp = parse_stamp(stamps.at(rng() % stamps.size())).value();
    const auto count = static_cast<int>(rng() % 4);
    for (int id = 1; id <= count; ++id) {
      const double x = rng() % 6400 / 10.0, y = rng() / 1e7;
      frame.objects.push_back({id,
                               coco_name(random_class_name(rng)),
                               static_cast<float>(rng() % 1001) / 1000.F,
                               {x, y, x + 1.0 / 3.0, y + 7.7}});
      ASSERT_TRUE(is_class_name(frame.objects.back().class_name));
    }
    const std::string line = format_detections_line(frame);
    const DetectionsLine read = parse(line);
    EXPECT_EQ(read.stamp.text, frame.stamp.text);
    EXPECT_EQ(read.stamp.seconds, frame.stamp.seconds);
    EXPECT_EQ(read.objects, frame.objects) << line;
  }
}

}  // namespace
}  // namespace stillmap
