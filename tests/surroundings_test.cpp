// SPDX-License-Identifier: Apache-2.0
// The program as another user, without a home, on data that cannot be written to, and in other
// languages.
#include <cstdlib>
#include <locale>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "stillmap/config/config_io.hpp"
#include "stillmap/io/ply.hpp"
#include "stillmap/io/trajectory_io.hpp"
#include "stillmap/sensor/camera_io.hpp"
#include "stillmap/session/system_config.hpp"
#include "tests/support/cli_fixture.hpp"
#include "tests/support/files.hpp"
#include "tests/support/plane_sequence.hpp"
#include "tooling/report/report_json.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class Surroundings : public Cli {
 protected:
  Surroundings() { write_plane_sequence(folder_ / "wall", 6); }

  static constexpr const char* kNobody = "setpriv --reuid=65534 --regid=65534 --clear-groups";
  [[nodiscard]] static bool can_be_nobody() {
    const std::string command =
        std::string(kNobody) + " '" STILLMAP_BINARY_DIR "/bin/stillmap' --version > /dev/null 2>&1";
    return ::geteuid() == 0 && std::system(command.c_str()) == 0;
  }
};

TEST_F(Surroundings, AnotherUserReadsWhatNobodyMayWrite) {
  if (!can_be_nobody()) GTEST_SKIP() << "needs root, setpriv and a build that all users can read";
  for (const auto& entry : fs::recursive_directory_iterator(folder_ / "wall")) {
    fs::permissions(entry.path(), fs::perms::owner_write, fs::perm_options::remove);
  }
  fs::permissions(folder_, fs::perms::all);
  const Outcome outcome = run("run wall --out out", kNobody);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(read_trajectory(folder_ / "out/trajectory.txt").size(), 6U);
  EXPECT_EQ(run("export out --ply map.ply", kNobody).exit_code, 0);
  // Over results of root, in a folder of root: one line, and they stay as they are.
  ASSERT_EQ(run("run wall --out of_root --frames 0:3").exit_code, 0);
  const std::string before = content("of_root/trajectory.txt");
  const Outcome refused = run("run wall --out of_root", kNobody);
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, testing::MatchesRegex("stillmap: [^\n]*of_root[^\n]*denied[^\n]*\n"));
  EXPECT_EQ(content("of_root/trajectory.txt"), before);
  // In a folder of root that all may write to, in which files can be replaced but not the folder.
  fs::permissions(folder_ / "of_root", fs::perms::all);
  const Outcome shared = run("run wall --out of_root", kNobody);
  EXPECT_EQ(shared.exit_code, 0) << shared.err;
  EXPECT_EQ(read_trajectory(folder_ / "of_root/trajectory.txt").size(), 6U);
}

// A folder of the working directory must not be taken for one of networks: a library is loaded from
// there.
TEST_F(Surroundings, WithoutAHomeNothingOfTheWorkingFolderIsLoaded) {
  const Outcome outcome =
      run("run wall --out out --segmenter auto", "env -u HOME -u XDG_DATA_HOME -u STILLMAP_MODELS");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("there is no /"));
  EXPECT_EQ(run("run wall --out out --segmenter none", "env -i").exit_code, 0);
  EXPECT_THAT(run("run wall --out out --segmenter auto",
                  "env -u STILLMAP_MODELS XDG_DATA_HOME=relative HOME=/none")
                  .err,
              HasSubstr("there is no /none/.local/share/stillmap"));
}

// Numbers with a comma, and letters whose capitals are others.
TEST_F(Surroundings, LanguagesMakeNoDifference) {
  fs::create_directories(folder_ / "locales");
  for (const std::string name : {"de_DE", "tr_TR"}) {
    const std::string compile = "localedef -i " + name + " -f UTF-8 " +
                                path("locales/" + name + ".UTF-8") + " > /dev/null 2>&1";
    if (std::system(compile.c_str()) != 0) GTEST_SKIP() << "localedef cannot make " << name;
  }
  const std::string options = " --set cloud.voxel_size_m=0.0125";
  ASSERT_EQ(run("run wall --out c" + options, "env LC_ALL=C").exit_code, 0);
  for (const std::string name : {"de_DE", "tr_TR"}) {
    const std::string language = "env LOCPATH=" + path("locales") + " LC_ALL=" + name + ".UTF-8";
    ASSERT_EQ(run("run wall --out " + name + options, language).exit_code, 0);
    for (const char* file : {"/trajectory.txt", "/camera.yaml", "/map.ply"}) {
      EXPECT_TRUE(content(name + file) == content(std::string("c") + file)) << name << file;
    }
  }
}

struct Comma : std::numpunct<char> {
  [[nodiscard]] char do_decimal_point() const override { return ','; }
  [[nodiscard]] char do_thousands_sep() const override { return '.'; }
  [[nodiscard]] std::string do_grouping() const override { return "\3"; }
};

// All files that the library writes, by a host program with a language of its own.
std::string all_texts() {
  SystemConfig config;
  PointCloud cloud;
  cloud.positions = {{1234.5F, -0.25F, 1e-6F}};
  cloud.colors = {{1, 2, 3}};
  const Trajectory trajectory = {
      {{1234567.5, ""}, Eigen::Isometry3d(Eigen::Translation3d(1234.5, 0, 0))}};
  RunReport report;
  report.wall_s = 12345.5;
  return dump_yaml(list_fields(config)) + format_camera_yaml(builtin_camera("tum_fr1")) +
         encode_ply(cloud, PlyFormat::kAscii) + format_trajectory(trajectory) + report_json(report);
}

TEST(HostProgram, ItsLanguageMakesNoDifference) {
  const std::string classic = all_texts();
  const std::locale before = std::locale::global(std::locale(std::locale::classic(), new Comma));
  const std::string comma = all_texts();
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "camera.yaml") << format_camera_yaml(builtin_camera("tum_fr1"));
  std::ofstream(folder.path() / "config.yaml") << "cloud:\n  voxel_size_m: 0.0125\n";
  SystemConfig config;
  const CameraModel camera = read_camera_yaml(folder.path() / "camera.yaml");
  load_yaml(list_fields(config), folder.path() / "config.yaml");
  std::locale::global(before);
  EXPECT_TRUE(comma == classic);
  EXPECT_EQ(camera.fx, builtin_camera("tum_fr1").fx);
  EXPECT_EQ(config.cloud.voxel_size_m, 0.0125);
}

}  // namespace
}  // namespace stillmap
