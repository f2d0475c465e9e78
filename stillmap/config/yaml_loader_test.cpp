// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "stillmap/config/config_io.hpp"
#include "stillmap/core/error.hpp"
#include "tests/support/sample_config.hpp"

namespace stillmap {
namespace {

using test::Config;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

class LoadYaml : public testing::Test {
 protected:
  LoadYaml() {
    const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() /
              fmt::format("stillmap_yaml_loader_{}_{}", test->name(), getpid());
    std::filesystem::create_directories(folder_);
  }
  ~LoadYaml() override { std::filesystem::remove_all(folder_); }

  Config load(const std::string& text) {
    std::ofstream(file(), std::ios::binary) << text;
    Config config;
    load_yaml(list_fields(config), file());
    return config;
  }

  // The error's text without the folder: "c.yaml:2: ...".
  std::string error(const std::string& text) {
    try {
      load(text);
    } catch (const Error& error) {
      const std::string what = error.what();
      EXPECT_EQ(what.find('\n'), std::string::npos) << what;
      EXPECT_LT(what.size(), 1000U);
      const std::string prefix = (folder_ / "").string();
      return what.starts_with(prefix) ? what.substr(prefix.size()) : what;
    }
    return "no error";
  }

  [[nodiscard]] std::filesystem::path file() const { return folder_ / "c.yaml"; }
  [[nodiscard]] std::filesystem::path folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
};

std::string repeated(std::string_view text, int times) {
  std::string result;
  for (int i = 0; i < times; ++i) result += text;
  return result;
}

TEST_F(LoadYaml, TextIsReadAsAFileIs) {
  Config config;
  EXPECT_THROW(load_yaml_text(list_fields(config), "nothing: 1", "x"), Error);
  EXPECT_THROW(load_yaml_text(list_fields(config), "", "x"), Error);
  EXPECT_THROW(load_yaml_text(list_fields(config), std::string((1U << 20U) + 1, ' '), "x"), Error);
  const std::string text = dump_yaml(list_fields(config));
  Config again;
  load_yaml_text(list_fields(again), text, "x");
  EXPECT_EQ(dump_yaml(list_fields(again)), text);
}

TEST_F(LoadYaml, UnknownKeysAreSkippedWhereAsked) {
  const auto read = [](const std::string& text) {
    Config config;
    load_yaml_text(list_fields(config), text, "x", UnknownKeys::kSkip);
    return config.seed;
  };
  for (const char* unknown : {"gone: 1\n",
                              "gone:\n",
                              "gone: [1, [2, {a: b}]]\n",
                              "gone:\n  deep:\n    deeper: 1\n  list: []\n",
                              "tracking:\n  gone: 1\n"}) {
    EXPECT_EQ(read(unknown + std::string("seed: 7\n")), 7) << unknown;
  }
  EXPECT_THROW((void)read("gone: 1\nseed: x\n"), Error);
}

TEST_F(LoadYaml, SetsWhatTheFileNamesAndNothingElse) {
  const Config config = load(
      "# a comment\r\n"
      "seed: 42\r\n"
      "dynamics: off\r\n"
      "tracking:\r\n"
      "  max_depth_m: 4.5  # m\r\n"
      "  loop: {enabled: false, min_score: 1}\r\n"
      "note: 'it''s'\r\n");
  EXPECT_EQ(config.seed, 42U);
  EXPECT_EQ(config.dynamics, "off");
  EXPECT_EQ(config.tracking.max_depth_m, 4.5);
  EXPECT_FALSE(config.tracking.loop.enabled);
  EXPECT_EQ(config.tracking.loop.min_score, 1.0);
  EXPECT_EQ(config.note, "it's");
  EXPECT_EQ(config.tracking.features, 1000);
  EXPECT_EQ(config.gain, 0.1);
}

TEST_F(LoadYaml, AcceptsAFileWithEverythingCommentedOut) {
  EXPECT_EQ(load("# seed: 4\n").seed, 1U);
  EXPECT_EQ(load("---\nseed: 2\ntracking:\n  # features: 5\n").tracking.features, 1000);
  EXPECT_EQ(load("\xEF\xBB\xBFseed: 9\n").seed, 9U) << "byte order mark";
  EXPECT_EQ(load("tracking.loop.enabled: false\n").tracking.loop.enabled, false);
  EXPECT_EQ(load("seed: 3\n...\n").seed, 3U);
}

TEST_F(LoadYaml, NamesAnUnknownKeyAndTheNearest) {
  EXPECT_EQ(error("seed: 1\ntracking:\n  feature: 500\n"),
            "c.yaml:3: unknown key 'tracking.feature': did you mean 'tracking.features'?");
  EXPECT_EQ(error("trackin: {features: 500}\n"),
            "c.yaml:1: unknown key 'trackin': did you mean 'tracking'?");
  EXPECT_EQ(
      error("features: 500\n"),
      "c.yaml:1: unknown key 'features': known: seed, offset, gain, dynamics, note, tracking, "
      "last");
  EXPECT_THAT(error("<<: {seed: 1}\n"), StartsWith("c.yaml:1: unknown key '<<'"));
}

TEST_F(LoadYaml, NamesAWrongValue) {
  EXPECT_EQ(error("seed: 1\n\ntracking:\n  max_depth_m: deep\n"),
            "c.yaml:4: tracking.max_depth_m: expected a number from 0.1 to 20 m, got 'deep'");
  EXPECT_EQ(error("tracking:\n  features: 1e3\n"),
            "c.yaml:2: tracking.features: expected a whole number from 100 to 10000, got '1e3'");
  EXPECT_EQ(error("tracking:\n  features: \"500\"\n"),
            "c.yaml:2: tracking.features: expected a whole number from 100 to 10000, got \"500\"");
  EXPECT_EQ(error("gain: .nan\n"), "c.yaml:1: gain: expected a number in 1/s, got '.nan'");
  EXPECT_EQ(error("gain: nan\n"), "c.yaml:1: gain: expected a number in 1/s, got 'nan'");
  EXPECT_EQ(error("gain: .inf\n"), "c.yaml:1: gain: expected a number in 1/s, got '.inf'");
  EXPECT_EQ(error("gain:\n"), "c.yaml:1: gain: expected a number in 1/s, got nothing");
  EXPECT_EQ(error("note: ~\n"), "c.yaml:1: note: expected a text on one line, got nothing");
  EXPECT_EQ(error("note: \"a\\nb\"\n"), "c.yaml:1: note: expected a text on one line, got \"a?b\"");
  EXPECT_EQ(error("gain: [1]\n"), "c.yaml:1: gain: expected a number in 1/s, got a list");
  EXPECT_EQ(error("gain: {a: 1}\n"), "c.yaml:1: gain: expected a number in 1/s, got a map");
  EXPECT_EQ(error("tracking:\n  loop:\n    enabled: yes\n"),
            "c.yaml:3: tracking.loop.enabled: expected true or false, got 'yes'");
}

TEST_F(LoadYaml, NamesAWrongStructure) {
  EXPECT_EQ(
      error("tracking: 5\n"),
      "c.yaml:1: 'tracking' is a group of keys such as 'tracking.features' and takes no value "
      "itself");
  EXPECT_EQ(error("tracking: [5]\n"), "c.yaml:1: tracking: expected a map of keys, got a list");
  EXPECT_EQ(error("\n- seed: 1\n"),
            "c.yaml:2: expected a map of keys ('key: value' lines), got a list");
  EXPECT_EQ(error("seed\n"), "c.yaml:1: expected a map of keys ('key: value' lines)");
  EXPECT_EQ(error("---\n~\n"), "c.yaml:2: expected a map of keys ('key: value' lines)");
  EXPECT_EQ(error("? {a: b}\n: 1\n"), "c.yaml:1: expected a key, got a map");
  EXPECT_EQ(error("? [a]\n: 1\n"), "c.yaml:1: expected a key, got a list");
  EXPECT_EQ(error("~: 1\n"), "c.yaml:1: expected a key, got nothing");
  EXPECT_EQ(error("seed: 1\n---\nseed: 2\n"),
            "c.yaml:2: expected one YAML document, this is a second one");
}

TEST_F(LoadYaml, RefusesRepeatedKeys) {
  EXPECT_EQ(error("seed: 1\ngain: 2\nseed: 1\n"), "c.yaml:3: seed: repeated key");
  EXPECT_EQ(error("tracking: {features: 500}\ntracking: {max_depth_m: 1}\n"),
            "c.yaml:2: tracking: repeated key");
  EXPECT_EQ(error("tracking: {features: 500}\ntracking.features: 600\n"),
            "c.yaml:2: tracking.features: repeated key");
}

TEST_F(LoadYaml, RefusesAnchorsAliasesAndTags) {
  EXPECT_EQ(error("seed: &a 1\noffset: *a\n"),
            "c.yaml:1: anchors are not supported, write the value out");
  EXPECT_EQ(error("tracking: &a\n  features: 500\n"),
            "c.yaml:1: anchors are not supported, write the value out");
  EXPECT_THAT(error("seed: *a\n"), StartsWith("c.yaml:1: not valid YAML: "));
  EXPECT_EQ(error("seed: !!str 1\n"),
            "c.yaml:1: tags such as 'tag:yaml.org,2002:str' are not supported");
}

TEST_F(LoadYaml, NamesTheLineOfASyntaxError) {
  EXPECT_THAT(error("seed: 1\ntracking: {features: 500\n"), StartsWith("c.yaml:"));
  EXPECT_THAT(error("seed: 1\nnote: \"open\n"), StartsWith("c.yaml:2: not valid YAML"));
  EXPECT_THAT(error("seed: 1\nnote: 'open\n\n"), StartsWith("c.yaml:2: not valid YAML"));
  EXPECT_EQ(error("seed: 1\n%YAML 1.2\n"), "c.yaml:2: directives ('%' lines) are not supported");
  EXPECT_THAT(error("seed: 1\n\tgain: 2\n"), StartsWith("c.yaml:"));
}

TEST_F(LoadYaml, NamesAFileThatCannotBeRead) {
  Config config;
  const auto error_of = [&](const std::filesystem::path& path) -> std::string {
    try {
      load_yaml(list_fields(config), path);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_EQ(error_of(folder() / "none.yaml"),
            (folder() / "none.yaml").string() + ": cannot be opened: No such file or directory");
  EXPECT_EQ(error_of(folder()), folder().string() + ": a folder, expected a YAML file");
  EXPECT_EQ(error_of("/dev/zero"), "/dev/zero: larger than 1 MiB, not a configuration");
  EXPECT_THAT(error_of(""), HasSubstr("cannot be opened"));
}

TEST_F(LoadYaml, RefusesHostileFilesQuickly) {
  const auto start = std::chrono::steady_clock::now();
  std::string bomb = "a: &a [x,x,x,x,x,x,x,x,x]\n";
  for (char c = 'b'; c < 'z'; ++c)
    bomb += fmt::format("{0}: &{0} [{1}]\n", c, repeated(fmt::format("*{},", char(c - 1)), 9));
  EXPECT_THAT(error(bomb), StartsWith("c.yaml:1: unknown key 'a'"));
  EXPECT_THAT(error("note: &a [x,x]\nlast: [*a,*a]\n"), StartsWith("c.yaml:1: "));
  for (const char* piece : {"[",
                            "{",
                            "{a: ",
                            "- ",
                            "? ",
                            "&a ",
                            "!a ",
                            "tracking: {",
                            "a: ",
                            "\"",
                            "'",
                            "|\n",
                            ">\n ",
                            "%",
                            "*a ",
                            ", ",
                            ": ",
                            "---\n",
                            "seed: 1\n"}) {
    EXPECT_NE(error(repeated(piece, 100000)), "no error") << piece;
    EXPECT_NE(error(fmt::format("tracking: {}", repeated(piece, 100000))), "no error") << piece;
  }
  EXPECT_EQ(error(std::string(1048577, ' ')), "c.yaml: larger than 1 MiB, not a configuration");
  EXPECT_EQ(error(" \n\n"), "c.yaml: empty, expected a YAML file");
  EXPECT_EQ(error(""), "c.yaml: empty, expected a YAML file");
  const auto elapsed = std::chrono::steady_clock::now() - start;
  EXPECT_LT(std::chrono::duration<double>(elapsed).count(), 60.0);
}

TEST_F(LoadYaml, RefusesWhatIsNotText) {
  EXPECT_EQ(error(std::string("seed: 1\n\0", 9)),
            "c.yaml:2: byte 0x00 is not UTF-8 text, expected a YAML file");
  EXPECT_EQ(error("note: caf\xe9\n"),
            "c.yaml:1: byte 0xe9 is not UTF-8 text, expected a YAML file");
  EXPECT_EQ(error(std::string("\xff\xfes\0e\0", 6)),
            "c.yaml:1: byte 0xff is not UTF-8 text, expected a YAML file");
  EXPECT_EQ(error("\x89PNG\r\n\x1a\n"),
            "c.yaml:1: byte 0x89 is not UTF-8 text, expected a YAML file");
  EXPECT_THAT(error("note: \xe2\x82"), EndsWith("expected a YAML file")) << "cut UTF-8";
}

// Whatever a damaged file holds: it loads or it is an Error, and what loads is within its range.
TEST_F(LoadYaml, DamagedFilesAreErrorsOrGoodValues) {
  Config good;
  const std::string text = dump_yaml(list_fields(good));
  const std::string_view alphabet = "[]{}:,-?&*!|>'\"%@`#\n\t ~0x.\\a\xc3\xa9\xef";
  std::mt19937 random(3);
  int refused = 0;
  for (int round = 0; round < 2000; ++round) {
    std::string damaged = text;
    for (unsigned edit = 0; edit <= random() % 4; ++edit) {
      const std::size_t at = random() % damaged.size();
      switch (random() % 3) {
        case 0:
          damaged[at] = alphabet[random() % alphabet.size()];
          break;
        case 1:
          damaged.insert(at, 1, alphabet[random() % alphabet.size()]);
          break;
        default:
          damaged.erase(at, 1 + random() % 20);
          break;
      }
      if (damaged.empty()) break;
    }
    try {
      const Config config = load(damaged);
      EXPECT_GE(config.tracking.features, 100) << damaged;
      EXPECT_LE(config.tracking.max_depth_m, 20.0) << damaged;
      EXPECT_TRUE(config.dynamics == "full" || config.dynamics == "off") << damaged;
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 500);
}

}  // namespace
}  // namespace stillmap
