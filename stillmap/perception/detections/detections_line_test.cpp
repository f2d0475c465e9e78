// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/detections/detections_line.hpp"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

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

TEST(ParseDetectionsLine, RefusesStampsThatAreNoPlainNumbers) {
  ASSERT_EQ(parse(with("stamp", "\"12.5\"")).stamp.seconds, 12.5);
  for (const char* stamp :
       {"12.5",         "\"\"",      "\".5\"",     "\"5.\"",
        "\"1e9\"",      "\"-1\"",    "\"+1\"",     "\" 1\"",
        "\"1 \"",       "\"nan\"",   "\"inf\"",    "\"1.2.3\"",
        "\"..\"",       "\"../1\"",  "\"/etc/1\"", "\"1/2\"",
        "\"1\\u0000\"", "\"1\\n2\"", "\"0x10\"",   "\"123456789012345678901234567890.123\"",
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
  for (const char* name : {"\"\"", "3", "null", "[]", "\"a\\nb\"", "\"caf\xc3\xa9\""}) {
    EXPECT_THAT(refusal(with("class", name)), HasSubstr("object 3: class")) << name;
  }
  EXPECT_THAT(refusal(with("class", '"' + std::string(65, 'a') + '"')), HasSubstr("class"));
  EXPECT_EQ(parse(with("class", '"' + std::string(64, 'a') + '"')).objects.size(), 1U);
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

}  // namespace
}  // namespace stillmap
