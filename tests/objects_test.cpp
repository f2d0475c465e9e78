// SPDX-License-Identifier: Apache-2.0
// What `stillmap run` tells of objects: objects.jsonl, the map's labels, the report.
#include <sstream>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "stillmap/io/image_io.hpp"
#include "stillmap/io/ply.hpp"
#include "tests/support/cli_fixture.hpp"
#include "tests/support/plane_sequence.hpp"

namespace stillmap {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class Objects : public Cli {
 protected:
  static constexpr int kFrames = 30;

  // The wall, and a folder in which a part of it is called a person and another a chair, far from
  // each other. The camera slides, so the parts do, a little; one frame has missed the chair.
  Objects() {
    write_plane_sequence(folder_ / "wall", kFrames);
    std::filesystem::create_directories(folder_ / "found" / "masks");
    cv::Mat1b mask(240, 320, std::uint8_t{0});
    mask(cv::Rect(10, 10, 60, 100)).setTo(1);
    mask(cv::Rect(230, 150, 70, 70)).setTo(2);
    std::string lines;
    for (int i = 0; i < kFrames; ++i) {
      const std::string stamp = fmt::format("{:.6f}", 100 + i / 30.0);
      lines += R"({"stamp":")" + stamp +
               R"(","objects":[{"id":1,"class":"person","score":0.9,"box":[10,10,70,110]})";
      if (i != 12) lines += R"(,{"id":2,"class":"chair","score":0.8,"box":[230,150,300,220]})";
      lines += "]}\n";
      cv::Mat1b own = mask.clone();
      if (i == 12) own.setTo(0, own == 2);
      write("found/masks/" + stamp + ".png", encode_mask_png(own));
    }
    write("found/detections.jsonl", lines);
  }

  [[nodiscard]] std::vector<json> lines_of(const std::string& name) const {
    std::vector<json> lines;
    std::istringstream in(content(name));
    for (std::string line; std::getline(in, line);) lines.push_back(json::parse(line));
    return lines;
  }
};

TEST_F(Objects, AreToldOfAndLabelled) {
  const Outcome outcome =
      run("run wall --out out --segmenter detections:found --dynamics full --threads 2");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;

  const std::vector<json> lines = lines_of("out/objects.jsonl");
  ASSERT_EQ(lines.size(), static_cast<std::size_t>(kFrames));
  for (std::size_t i = 0; i < lines.size(); ++i) {
    EXPECT_EQ(lines[i].at("stamp"), fmt::format("{:.6f}", 100 + static_cast<int>(i) / 30.0));
    ASSERT_EQ(lines[i].at("objects").size(), 2U) << i;
    const json& person = lines[i].at("objects")[0];
    const json& chair = lines[i].at("objects")[1];
    EXPECT_EQ(person.at("class"), "person");
    EXPECT_EQ(person.at("state"), "dynamic");
    EXPECT_EQ(chair.at("class"), "chair");
    EXPECT_EQ(chair.at("filled"), i == 12) << i;
    EXPECT_EQ(chair.at("track"), lines[0].at("objects")[1].at("track"));
  }
  // The wall is 1.5 m before the first camera.
  EXPECT_NEAR(lines[5].at("objects")[1].at("p_world")[2].get<double>(), 1.5, 0.02);

  std::size_t chairs = 0, others = 0;
  for (const std::uint8_t label : read_ply(folder_ / "out" / "map.ply").labels) {
    chairs += label == 57 ? 1 : 0;
    others += label != 57 && label != 0 ? 1 : 0;
  }
  EXPECT_GT(chairs, 500U);
  EXPECT_EQ(others, 0U);

  const json report = json::parse(content("out/report.json"));
  EXPECT_EQ(report.at("dynamics").at("mode"), "full");
  EXPECT_EQ(report.at("objects").at("tracks"), 2);
  EXPECT_EQ(report.at("objects").at("sightings"), 2 * kFrames);
  EXPECT_EQ(report.at("objects").at("filled"), 1);
  EXPECT_EQ(report.at("objects").at("classes").at("person").at("dynamic"), kFrames);
  EXPECT_THAT(content("out/report.html"), HasSubstr("<svg class=\"boxes\""));
}

TEST_F(Objects, WithoutPeopleTheRunWarns) {
  std::string lines = content("found/detections.jsonl");
  for (std::size_t at = lines.find("person"); at != std::string::npos; at = lines.find("person")) {
    lines.replace(at, 6, "statue");
  }
  write("found/detections.jsonl", lines);
  const std::string command = "run wall --out out --segmenter detections:found --dynamics full";
  const Outcome outcome = run(command);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err,
              HasSubstr("warning: no object of a dynamic class, such as a person, was "
                        "found in any of 30 frames"));
  EXPECT_THAT(outcome.err, HasSubstr("taken for static: statue; "));
  const json report = json::parse(content("out/report.json"));
  EXPECT_TRUE(report.at("objects").at("first_dynamic_s").is_null());
  EXPECT_EQ(report.at("warnings").size(), 2U);
  EXPECT_THAT(content("out/report.html"), HasSubstr("was found in any of 30 frames"));

  const Outcome known = run(command + " --set dynamics.categories.synonyms=statue=person");
  ASSERT_EQ(known.exit_code, 0) << known.err;
  EXPECT_EQ(known.err, "");
  EXPECT_EQ(json::parse(content("out/report.json")).at("objects").at("first_dynamic_s"), 0);
}

TEST_F(Objects, AreTheSameToTheBitForAnyThreads) {
  const std::string command = " --segmenter detections:found --dynamics full --threads ";
  ASSERT_EQ(run("run wall --out a" + command + "1").exit_code, 0);
  ASSERT_EQ(run("run wall --out b" + command + "3").exit_code, 0);
  EXPECT_FALSE(content("a/objects.jsonl").empty());
  EXPECT_TRUE(content("a/objects.jsonl") == content("b/objects.jsonl"));
  EXPECT_TRUE(content("a/map.ply") == content("b/map.ply"));
}

// The chair is first found in frames 13 and 14, which is twice, as a track must be before it is
// believed: with three frames of delay frames 11 and 12 can know of it, live ones can't.
TEST_F(Objects, AreNotKnownBeforehandLive) {
  cv::Mat1b person(240, 320, std::uint8_t{0});
  person(cv::Rect(10, 10, 60, 100)).setTo(1);
  std::string lines;
  for (json& found : lines_of("found/detections.jsonl")) {
    const std::string stamp = found.at("stamp");
    if (stamp < "100.433333" && found.at("objects").size() == 2) {
      found.at("objects").erase(1);
      write("found/masks/" + stamp + ".png", encode_mask_png(person));
    }
    lines += found.dump() + "\n";
  }
  write("found/detections.jsonl", lines);
  const auto filled_before = [&](const std::string& flags) {
    EXPECT_EQ(run("run wall --out out --segmenter detections:found " + flags).exit_code, 0);
    std::size_t filled = 0;
    const std::vector<json> frames = lines_of("out/objects.jsonl");
    for (std::size_t i = 0; i < 13; ++i) filled += frames[i].at("objects").size() - 1;
    return filled;
  };
  EXPECT_EQ(filled_before(""), 2U);
  // A look at every frame that has come in before the frame itself is processed.
  std::string record;
  for (int i = 0; i < kFrames; ++i) {
    record += fmt::format(R"({{"frame":{0},"objects_of":[{0}]}})", i) + "\n";
  }
  write("live.jsonl", record);
  EXPECT_EQ(filled_before("--live --replay live.jsonl"), 0U);
}

TEST_F(Objects, OfALiveRunAreThoseOfTheRunMadeAgain) {
  const std::string command = "run wall --segmenter detections:found --live ";
  ASSERT_EQ(run(command + "--speed 5 --out a").exit_code, 0);
  ASSERT_EQ(run(command + "--replay a/live.jsonl --threads 1 --out b").exit_code, 0);
  for (const char* file :
       {"trajectory.txt", "objects.jsonl", "map.ply", "map.stillmap", "live.jsonl"}) {
    EXPECT_FALSE(content(std::string("a/") + file).empty()) << file;
    EXPECT_TRUE(content(std::string("a/") + file) == content(std::string("b/") + file)) << file;
  }
  const json live = json::parse(content("a/report.json")).at("live");
  EXPECT_EQ(live.at("speed"), 5.0);
  EXPECT_EQ(live.at("dropped").get<std::size_t>() + lines_of("a/live.jsonl").size(),
            static_cast<std::size_t>(kFrames));
  EXPECT_GT(live.at("latency_ms").at("p95"), 0.0);
  // A run that is not live has no record, not even that of an earlier one.
  ASSERT_EQ(run("run wall --out a").exit_code, 0);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a/live.jsonl"));
  EXPECT_TRUE(json::parse(content("a/report.json")).at("live").is_null());

  expect_refused("run wall --out c --replay a/live.jsonl", "--live");
  expect_refused("run wall --out c --speed 2", "--live");
  expect_refused("run wall --out c --live --speed 0", "--speed");
  expect_refused("run wall --out c --live --replay nowhere", "nowhere");
  write("bad.jsonl", "{\"frame\":99,\"objects_of\":[]}\n");
  expect_refused("run wall --out c --live --replay bad.jsonl", "bad.jsonl:1:");
}

// A rough mask and a box alone: `segment` gives them the masks that the run would.
TEST_F(Objects, OfSegmentAreThoseOfTheRun) {
  std::string lines = content("found/detections.jsonl");
  const std::string box = "[10,10,70,110]";
  for (std::size_t at = lines.find(box); at != std::string::npos; at = lines.find(box, at + 1)) {
    lines.insert(at + box.size(), R"(,"mask":"rough")");
  }
  write("found/detections.jsonl", lines);
  for (const auto& file : std::filesystem::directory_iterator(folder_ / "found/masks")) {
    const cv::Mat1b both = read_mask(file.path());
    cv::Mat1b person = both.clone();
    person.setTo(0, both != 1);
    write("found/masks/" + file.path().filename().string(), encode_mask_png(person));
  }
  ASSERT_EQ(run("segment wall --out again --segmenter detections:found").exit_code, 0);
  const std::string again = content("again/detections.jsonl");
  EXPECT_THAT(again, HasSubstr(R"("mask":"depth")"));
  EXPECT_THAT(again, testing::Not(HasSubstr("rough")));
  for (const std::string from : {"found", "again"}) {
    ASSERT_EQ(run("run wall --out " + from + "-run --segmenter detections:" + from +
                  " --write-objects " + from + "-used")
                  .exit_code,
              0);
  }
  for (const std::string file : {"-run/trajectory.txt",
                                 "-run/objects.jsonl",
                                 "-run/map.ply",
                                 "-used/detections.jsonl",
                                 "-used/masks/100.400000.png",
                                 "-used/masks/100.433333.png"}) {
    EXPECT_EQ(content("found" + file), content("again" + file)) << file;
  }
}

TEST_F(Objects, OfAnEarlierRunDoNotStay) {
  ASSERT_EQ(run("run wall --out out --segmenter detections:found --dynamics mask").exit_code, 0);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out/objects.jsonl"));
  ASSERT_EQ(run("run wall --out out --segmenter none --dynamics mask").exit_code, 0);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out/objects.jsonl"));
  ASSERT_EQ(run("run wall --out out --segmenter detections:found --dynamics off").exit_code, 0);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out/objects.jsonl"));
  const json report = json::parse(content("out/report.json"));
  EXPECT_EQ(report.at("dynamics").at("mode"), "off");
  EXPECT_TRUE(report.at("objects").at("tracks").is_null());
}

}  // namespace
}  // namespace stillmap
