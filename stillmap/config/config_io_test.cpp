// SPDX-License-Identifier: Apache-2.0
#include "stillmap/config/config_io.hpp"

#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <span>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "stillmap/core/error.hpp"
#include "tests/support/sample_config.hpp"

namespace stillmap {
namespace {

using test::Config;
using testing::ElementsAre;
using testing::HasSubstr;

std::string set_error(const std::string& assignment) {
  Config config;
  try {
    set_value(list_fields(config), assignment, "--set");
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

// The values a file with this text gives.
Config loaded(const std::string& yaml) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / fmt::format("stillmap_config_io_{}.yaml", getpid());
  std::ofstream(file, std::ios::binary) << yaml;
  Config config;
  load_yaml(list_fields(config), file);
  std::filesystem::remove(file);
  return config;
}

TEST(ListFields, NamesEveryFieldInOrder) {
  Config config;
  std::vector<std::string> keys;
  for (const FieldRef& field : list_fields(config)) keys.push_back(field.key);
  EXPECT_THAT(keys,
              ElementsAre("seed",
                          "offset",
                          "gain",
                          "dynamics",
                          "note",
                          "tracking.features",
                          "tracking.max_depth_m",
                          "tracking.loop.enabled",
                          "tracking.loop.min_score",
                          "last"));
}

TEST(SetValue, SetsEveryType) {
  Config config;
  const std::vector<FieldRef> fields = list_fields(config);
  set_value(fields, "seed=4294967295");
  set_value(fields, "offset=+7");
  set_value(fields, "gain=-1.5e-3");
  set_value(fields, "dynamics=off");
  set_value(fields, "note=a = b, \"c\": ü");
  set_value(fields, "tracking.features=100");
  set_value(fields, "tracking.loop.enabled=false");
  EXPECT_EQ(config.seed, 4294967295U);
  EXPECT_EQ(config.offset, 7);
  EXPECT_EQ(config.gain, -0.0015);
  EXPECT_EQ(config.dynamics, "off");
  EXPECT_EQ(config.note, "a = b, \"c\": ü");
  EXPECT_EQ(config.tracking.features, 100);
  EXPECT_FALSE(config.tracking.loop.enabled);
  set_value(fields, "note=");
  EXPECT_EQ(config.note, "");
}

TEST(SetValue, SaysWhatWasExpected) {
  EXPECT_EQ(set_error("tracking.features=many"),
            "--set: tracking.features: expected a whole number from 100 to 10000, got 'many'");
  EXPECT_EQ(set_error("tracking.max_depth_m=20.1"),
            "--set: tracking.max_depth_m: expected a number from 0.1 to 20 m, got '20.1'");
  EXPECT_EQ(set_error("seed=-1"), "--set: seed: expected a whole number at least 0, got '-1'");
  EXPECT_EQ(set_error("offset=1.0"), "--set: offset: expected a whole number, got '1.0'");
  EXPECT_EQ(set_error("gain=fast"), "--set: gain: expected a number in 1/s, got 'fast'");
  EXPECT_EQ(set_error("last=-1"), "--set: last: expected a number at least 0 m, got '-1'");
  EXPECT_EQ(set_error("dynamics=Off"), "--set: dynamics: expected one of off, full, got 'Off'");
  EXPECT_EQ(set_error("tracking.loop.enabled=1"),
            "--set: tracking.loop.enabled: expected true or false, got '1'");
  EXPECT_EQ(set_error("note=two\nlines"),
            "--set: note: expected a text on one line, got 'two?lines'");
}

TEST(SetValue, RefusesWhatIsNoNumberOrFitsNoType) {
  for (const char* text : {"nan",
                           "NaN",
                           "inf",
                           "-inf",
                           "infinity",
                           "1e999",
                           "-1e999",
                           "",
                           " ",
                           "1 ",
                           " 1",
                           "1,5",
                           "0x10",
                           "+-1",
                           "--1",
                           "1e",
                           "1.2.3",
                           "1_000"}) {
    EXPECT_THAT(set_error(std::string("gain=") + text), HasSubstr("--set: gain: expected a number"))
        << text;
  }
  for (const char* text : {"4294967296", "-1", "1e3", "99999999999999999999", "0b1", ""}) {
    EXPECT_THAT(set_error(std::string("seed=") + text), HasSubstr("--set: seed: expected a whole"))
        << text;
  }
  EXPECT_THAT(set_error("offset=2147483648"), HasSubstr("expected a whole number"));
  EXPECT_THAT(set_error("note=\xff"), HasSubstr("got '?'"));
}

TEST(SetValue, HelpsWithAMisspeltKey) {
  EXPECT_EQ(set_error("tracking.feature=1"),
            "--set: unknown key 'tracking.feature': did you mean 'tracking.features'?");
  EXPECT_EQ(set_error("traking.features=1"),
            "--set: unknown key 'traking.features': did you mean 'tracking.features'?");
  EXPECT_EQ(set_error("tracking.zzzzzzzzzzzzzzzz=1"),
            "--set: unknown key 'tracking.zzzzzzzzzzzzzzzz': known: tracking.features, "
            "tracking.max_depth_m, tracking.loop");
  EXPECT_EQ(set_error("sed=1"), "--set: unknown key 'sed': did you mean 'seed'?");
  EXPECT_THAT(set_error("=1"), HasSubstr("--set: unknown key ''"));
  EXPECT_EQ(set_error("seed"), "--set seed: expected key=value");
  EXPECT_EQ(
      set_error("tracking.loop=1"),
      "--set: 'tracking.loop' is a group of keys such as 'tracking.loop.enabled' and takes no "
      "value itself");
  EXPECT_LT(set_error(std::string(100000, 'x') + "=1").size(), 300U);
}

TEST(SetValue, AfterAnErrorTheValueIsAsBefore) {
  Config config;
  EXPECT_THROW(set_value(list_fields(config), "tracking.features=5"), Error);
  EXPECT_EQ(config.tracking.features, 1000);
}

TEST(DumpYaml, WritesNestedMapsWithComments) {
  Config config;
  config.note = "say \"hi\" \\ #1";
  EXPECT_EQ(dump_yaml(list_fields(config)),
            "seed: 1                   # start of all random numbers\n"
            "offset: -3                # any whole number\n"
            "gain: 0.1                 # any number (1/s)\n"
            "dynamics: \"full\"          # method\n"
            "note: \"say \\\"hi\\\" \\\\ #1\"  # free text\n"
            "tracking:\n"
            "  features: 1000          # corners a frame\n"
            "  max_depth_m: 6          # farthest depth used (m)\n"
            "  loop:\n"
            "    enabled: true         # close loops\n"
            "    min_score: 0.25       # similarity that suffices\n"
            "last: 2.5                 # after a group (m)\n");
}

TEST(DumpYaml, LoadsBackToTheSameValues) {
  Config config;
  config.seed = 4294967295U;
  config.offset = std::numeric_limits<int>::min();
  config.dynamics = "off";
  config.note = " ~ null: \"x\" \\n # {[&*!|>%@` ü 地 ";
  config.tracking.features = 9999;
  config.tracking.loop.enabled = false;
  const Config back = loaded(dump_yaml(list_fields(config)));
  EXPECT_EQ(back.seed, config.seed);
  EXPECT_EQ(back.offset, config.offset);
  EXPECT_EQ(back.dynamics, config.dynamics);
  EXPECT_EQ(back.note, config.note);
  EXPECT_EQ(back.tracking.features, config.tracking.features);
  EXPECT_EQ(back.tracking.loop.enabled, config.tracking.loop.enabled);
}

TEST(DumpYaml, LoadsBackEveryDoubleToTheSameBits) {
  using Limits = std::numeric_limits<double>;
  std::vector<double> values = {0.0,
                                -0.0,
                                0.1,
                                1.0 / 3.0,
                                1e22,
                                1e23,
                                123456789.0,
                                5e-324,
                                Limits::min(),
                                Limits::max(),
                                Limits::lowest(),
                                9007199254740993.0};
  std::mt19937_64 random(7);
  while (values.size() < 500) {
    const auto value = std::bit_cast<double>(random());
    if (std::isfinite(value)) values.push_back(value);
  }
  for (const double value : values) {
    Config config;
    config.gain = value;
    const Config back = loaded(dump_yaml(list_fields(config)));
    EXPECT_EQ(std::bit_cast<std::uint64_t>(back.gain), std::bit_cast<std::uint64_t>(value))
        << value;
  }
}

TEST(DumpYaml, AnyTextStaysOneLoadableText) {
  std::mt19937_64 random(11);
  for (int round = 0; round < 300; ++round) {
    Config config;
    const std::size_t length = random() % 40;
    while (config.note.size() < length) config.note += static_cast<char>(0x20 + random() % 0x5F);
    EXPECT_EQ(loaded(dump_yaml(list_fields(config))).note, config.note);
  }
}

TEST(CommonFields, AreThoseMarked) {
  Config config;
  std::vector<std::string> keys;
  for (const FieldRef& field : common_fields(list_fields(config))) keys.push_back(field.key);
  EXPECT_THAT(keys, ElementsAre("seed", "tracking.features"));
}

TEST(Describe, AlignsColumns) {
  test::TrackingConfig config;
  EXPECT_EQ(describe(list_fields(config)),
            "KEY             VALUE  ALLOWED\n"
            "features        1000   100 to 10000\n"
            "    corners a frame\n"
            "max_depth_m     6 m    0.1 to 20\n"
            "    farthest depth used\n"
            "loop.enabled    true   true, false\n"
            "    close loops\n"
            "loop.min_score  0.25   0 to 1\n"
            "    similarity that suffices\n");
}

TEST(Describe, ShowsChoicesAndEmptyTexts) {
  Config config;
  const std::string text = describe(list_fields(config));
  EXPECT_THAT(text, HasSubstr("off, full"));
  EXPECT_THAT(text, HasSubstr("note                     \"\"\n"));
  EXPECT_THAT(text, HasSubstr("at least 0"));
}

// Whatever the lengths of value, meaning and choices, lines stay within 100 characters, and all
// words are there in their order.
TEST(Describe, WrapsLongTexts) {
  const std::vector<std::string> words = {"mask", "person", "wine-glass", "a", "0.25", "b,"};
  std::mt19937 random(5);
  const auto text_of = [&](std::size_t count) {
    std::string text = "x";
    for (std::size_t i = 1; i < count; ++i) text += " " + words[random() % words.size()];
    return text;
  };
  for (int round = 0; round < 300; ++round) {
    std::string value = text_of(1 + random() % 60);
    const std::string meaning = text_of(1 + random() % 60);
    FieldRef field{"group.key", &value, {meaning}};
    field.info.choices.assign(random() % 30, "choice");
    const std::string table = describe(std::span(&field, 1));
    std::istringstream lines(table);
    std::string flat;
    for (std::string line; std::getline(lines, line);) {
      EXPECT_LE(line.size(), 100U) << table;
      EXPECT_FALSE(line.ends_with(' ')) << table;
      std::istringstream in_line(line);
      for (std::string word; in_line >> word;) flat += word + " ";
    }
    EXPECT_THAT(flat, HasSubstr(meaning + " "));
    EXPECT_THAT(flat, HasSubstr(value + " "));
  }
}

}  // namespace
}  // namespace stillmap
