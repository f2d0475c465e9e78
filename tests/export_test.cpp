// SPDX-License-Identifier: Apache-2.0
// `stillmap export` from outside: what it writes, that other programs read it, and how it refuses.
#include <cmath>
#include <cstdio>
#include <sstream>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include "stillmap/io/atomic_file.hpp"
#include "stillmap/io/ply.hpp"
#include "stillmap/io/trajectory_io.hpp"
#include "stillmap/sensor/camera_io.hpp"
#include "tests/support/cli_fixture.hpp"
#include "tests/support/room.hpp"

namespace stillmap {
namespace {

using testing::HasSubstr;
using testing::MatchesRegex;
using testing::StartsWith;

// A run folder with a room whose truth is known, in the frame of its first camera.
class Export : public Cli {
 protected:
  Export() {
    const std::filesystem::path result = folder_ / "result";
    std::filesystem::create_directory(result);
    room_.move(room_.T_world_room());
    for (std::size_t i = 0; i < room_.cloud.size(); ++i) {
      room_.cloud.labels[i] = static_cast<std::uint8_t>(i % 81);
    }
    Trajectory keyframes;
    for (const Eigen::Isometry3d& pose : room_.poses) {
      const std::string stamp = fmt::format("{}.5", keyframes.size());
      keyframes.push_back({{std::stod(stamp), stamp}, pose});
    }
    write_file_atomically(result / "map.ply", encode_ply(room_.cloud));
    write_file_atomically(result / "keyframes.txt", format_trajectory(keyframes));
    write_file_atomically(result / "camera.yaml", format_camera_yaml(room_.camera));
  }

  void expect_refused(const std::string& arguments, const std::string& part) const {
    Cli::expect_refused("export " + arguments, part);
  }

  [[nodiscard]] bool exists(const std::string& name) const {
    return std::filesystem::exists(folder_ / name);
  }

  // Whether a program of that name can be run here.
  [[nodiscard]] static bool have(const std::string& program) {
    return std::system(("command -v " + program + " > /dev/null").c_str()) == 0;
  }

  // Runs a shell command in the test's folder.
  [[nodiscard]] int shell(const std::string& command) const {
    return std::system(
        ("cd '" + folder_.string() + "' && { " + command + "; } > log.txt 2>&1").c_str());
  }

  void expect_same_points(const std::string& ply_file) const {
    const PointCloud read = read_ply(folder_ / ply_file);
    EXPECT_EQ(read.positions, room_.cloud.positions);
    EXPECT_EQ(read.colors, room_.cloud.colors);
  }

  TestRoom room_;
};

TEST_F(Export, PlyIsTheRunsMap) {
  const Outcome outcome = run("export result --ply a.ply --ply-ascii b.ply");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, MatchesRegex(" *[0-9]+ bytes  a.ply\n *[0-9]+ bytes  b.ply\n"));
  EXPECT_TRUE(content("a.ply") == content("result/map.ply"));
  expect_same_points("b.ply");
  EXPECT_EQ(read_ply(folder_ / "b.ply").labels, room_.cloud.labels);
}

TEST_F(Export, PcdIsReadByPcl) {
  if (!have("pcl_pcd2ply") || !have("pcl_convert_pcd_ascii_binary")) {
    GTEST_SKIP() << "PCL's programs are absent (Debian: pcl-tools)";
  }
  ASSERT_EQ(run("export result --pcd a.pcd --pcd-ascii b.pcd").exit_code, 0);
  ASSERT_EQ(shell("pcl_pcd2ply -format 1 a.pcd a.ply"), 0) << content("log.txt");
  expect_same_points("a.ply");
  // Text becomes, in PCL's hands, the very bytes that we write as binary; it leaves zeros behind
  // them.
  ASSERT_EQ(shell("pcl_convert_pcd_ascii_binary b.pcd c.pcd 1"), 0) << content("log.txt");
  const auto data = [&](const std::string& name) {
    const std::string bytes = content(name);
    const std::size_t at = bytes.find("DATA binary\n");
    return at == std::string::npos ? name : bytes.substr(at);
  };
  EXPECT_TRUE(data("c.pcd").starts_with(data("a.pcd")));
}

TEST_F(Export, CloudsAreReadByOpen3d) {
  if (shell("/usr/bin/python3 -c 'import open3d'") != 0) {
    GTEST_SKIP() << "Open3D is absent (Debian: python3-open3d)";
  }
  ASSERT_EQ(
      run("export result --pcd a.pcd --pcd-ascii b.pcd --ply c.ply --ply-ascii d.ply").exit_code,
      0);
  write("read.py",
        "import sys, open3d as o\n"
        "for name in ['a.pcd', 'b.pcd', 'c.ply', 'd.ply']:\n"
        "    cloud = o.io.read_point_cloud(name)\n"
        "    assert cloud.has_colors(), name\n"
        "    o.io.write_point_cloud(name + '.ply', cloud)\n");
  ASSERT_EQ(shell("/usr/bin/python3 read.py"), 0) << content("log.txt");
  for (const char* name : {"a.pcd.ply", "b.pcd.ply", "c.ply.ply", "d.ply.ply"}) {
    SCOPED_TRACE(name);
    expect_same_points(name);
  }
}

/// A run folder whose map is a ball with normals, of 30 cm around (0, 0, 2).
class ExportMesh : public Export {
 protected:
  ExportMesh() {
    PointCloud ball;
    for (int i = 0; i < 20000; ++i) {
      const double z = 1 - (2 * i + 1.0) / 20000, angle = 2.399963229728653 * i;
      const double r = std::sqrt(1 - z * z);
      const Eigen::Vector3f out =
          Eigen::Vector3d(r * std::cos(angle), r * std::sin(angle), z).cast<float>();
      ball.positions.emplace_back(0.3F * out + Eigen::Vector3f(0, 0, 2));
      ball.normals.push_back(out);
      ball.colors.push_back({10, 200, 30});
      ball.labels.push_back(57);
    }
    write_file_atomically(folder_ / "result" / "map.ply", encode_ply(ball));
  }
};

TEST_F(ExportMesh, MeshesAreReadByAssimp) {
  if (!have("assimp")) GTEST_SKIP() << "assimp is absent (Debian: assimp-utils)";
  for (const std::string name : {"ball.ply", "ball.obj", "ball.glb"}) {
    SCOPED_TRACE(name);
    ASSERT_EQ(run("export result --mesh " + name).exit_code, 0);
    ASSERT_EQ(shell("assimp info " + name), 0) << content("log.txt");
    // The reader's bounds; y and z of a GLB are turned up by its node.
    std::istringstream info(content("log.txt"));
    std::vector<double> low(3), high(3);
    for (std::string line; std::getline(info, line);) {
      if (!line.starts_with("Minimum point") && !line.starts_with("Maximum point")) continue;
      std::vector<double>& point = line.starts_with("Min") ? low : high;
      ASSERT_EQ(
          std::sscanf(
              line.c_str() + line.find('('), "(%lf %lf %lf)", &point[0], &point[1], &point[2]),
          3);
    }
    const double middle_z = name.ends_with(".glb") ? -2 : 2;
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR((low[i] + high[i]) / 2, i == 2 ? middle_z : 0, 0.005) << i;
      EXPECT_NEAR(high[i] - low[i], 0.6, 0.01) << i;
    }
    EXPECT_THAT(content("log.txt"), HasSubstr("Meshes:             1"));
  }
}

TEST_F(ExportMesh, MeshesAreReadByOpen3d) {
  if (shell("/usr/bin/python3 -c 'import open3d'") != 0) {
    GTEST_SKIP() << "Open3D is absent (Debian: python3-open3d)";
  }
  ASSERT_EQ(run("export result --mesh ball.ply").exit_code, 0);
  write("read.py",
        "import open3d as o\n"
        "mesh = o.io.read_triangle_mesh('ball.ply')\n"
        "assert mesh.has_vertex_colors() and mesh.has_vertex_normals()\n"
        "assert mesh.is_watertight()\n"
        "assert abs(mesh.get_volume() - 0.1131) < 0.002, mesh.get_volume()\n");
  EXPECT_EQ(shell("/usr/bin/python3 read.py"), 0) << content("log.txt");
}

TEST_F(ExportMesh, RefusesWhatCannotBeDone) {
  expect_refused("result --mesh ball.stl", ".ply or .obj or .glb");
  expect_refused("result --mesh ball.ply --mesh-cell 0", "--mesh-cell");
  PointCloud without = read_ply(folder_ / "result" / "map.ply");
  without.normals.clear();
  write_file_atomically(folder_ / "result" / "map.ply", encode_ply(without));
  expect_refused("result --mesh ball.ply", "the map has no normals");
  EXPECT_FALSE(exists("ball.ply"));
}

TEST_F(Export, OctomapKnowsFreeOccupiedAndUnknown) {
  ASSERT_EQ(run("export result --octomap a.bt").exit_code, 0);
  ASSERT_EQ(run("export result --octomap b.ot --upright").exit_code, 0);
  std::istringstream binary(content("a.bt"));
  octomap::OcTree tree(1.0);
  ASSERT_TRUE(tree.readBinary(binary));
  std::istringstream full(content("b.ot"));
  const std::unique_ptr<octomap::AbstractOcTree> read(octomap::AbstractOcTree::read(full));
  auto* upright = dynamic_cast<octomap::OcTree*>(read.get());
  ASSERT_NE(upright, nullptr);
  const auto state = [](octomap::OcTree& in, const Eigen::Vector3d& p) {
    const octomap::OcTreeNode* node = in.search(p.x(), p.y(), p.z());
    return node == nullptr ? '?' : in.isNodeOccupied(node) ? '#' : '.';
  };
  // In the room's frame, which upright is but for the origin below the first camera.
  const Eigen::Isometry3d T_map_room = room_.poses.front() * TestRoom().poses.front().inverse();
  const auto both = [&](double x, double y, double z) {
    const Eigen::Vector3d p(x, y, z);
    return std::string{state(tree, T_map_room * p),
                       state(*upright, p - Eigen::Vector3d(0.3, 2, 0))};
  };
  EXPECT_EQ(both(1.0, 2.0, 1.0), "..");
  EXPECT_EQ(both(2.9, 2.0, 1.2), "..");
  EXPECT_EQ(both(3.02, 2.0, 1.2), "##");
  EXPECT_EQ(both(3.3, 2.0, 1.2), "??");
  EXPECT_EQ(both(1.8, 2.0, 0.72), "##");
  EXPECT_EQ(both(1.92, 2.0, 0.6), "??");
}

TEST_F(Export, OctomapIsReadByOctomapsOwnPrograms) {
  if (!have("bt2vrml") || !have("compare_octrees") || !have("convert_octree")) {
    GTEST_SKIP() << "OctoMap's programs are absent (Debian: octomap-tools)";
  }
  ASSERT_EQ(run("export result --octomap a.bt --resolution 0.1").exit_code, 0);
  ASSERT_EQ(run("export result --octomap b.ot --resolution 0.1").exit_code, 0);
  ASSERT_EQ(shell("bt2vrml a.bt"), 0) << content("log.txt");
  EXPECT_THAT(content("a.bt.wrl"), HasSubstr("Transform"));
  ASSERT_EQ(shell("convert_octree b.ot b.bt"), 0) << content("log.txt");
  EXPECT_TRUE(content("b.bt") == content("a.bt"));  // the same space, by OctoMap's own rule
}

TEST_F(Export, GridIsWhatMapServerExpects) {
  const Outcome outcome = run("export result --grid room.yaml");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("room.pgm\n"));
  EXPECT_THAT(content("room.yaml"),
              StartsWith("image: \"room.pgm\"\nmode: trinary\nresolution: 0.05\n"));
  EXPECT_THAT(content("room.pgm"), MatchesRegex("P5\n[0-9]+ [0-9]+\n255\n(.|\n)*"));
}

TEST_F(Export, GridIsReadAsMapServerReadsIt) {
  if (shell("/usr/bin/python3 -c 'import yaml, PIL'") != 0) {
    GTEST_SKIP() << "Python's YAML or images are absent (Debian: python3-yaml, python3-pil)";
  }
  ASSERT_EQ(run("export result --grid room.yaml").exit_code, 0);
  // The grid's frame has its origin below the first camera, at (0.3, 2) of the room.
  write("read.py",
        "import yaml, PIL.Image\n"
        "info = yaml.safe_load(open('room.yaml'))\n"
        "image = PIL.Image.open(info['image'])\n"
        "assert image.mode == 'L' and info['negate'] == 0\n"
        "def state(x, y):\n"
        "    u = int((x - 0.3 - info['origin'][0]) / info['resolution'])\n"
        "    v = int((y - 2.0 - info['origin'][1]) / info['resolution'])\n"
        "    occupancy = (255 - image.getpixel((u, image.height - 1 - v))) / 255\n"
        "    if occupancy > info['occupied_thresh']: return '#'\n"
        "    return '.' if occupancy < info['free_thresh'] else '?'\n"
        "print(''.join(state(*p) for p in [(1.8, 1.7), (1.8, 2.3), (1.0, 2.0), (1.0, 1.4),\n"
        "                                  (3.02, 1.5), (3.3, 2.0), (4.5, 2.0)]))\n"
        "T = info['T_grid_map']\n"
        "print(*[round(row[3], 2) for row in T])\n");
  ASSERT_EQ(shell("/usr/bin/python3 read.py"), 0) << content("log.txt");
  EXPECT_THAT(content("log.txt"), MatchesRegex("##..#\\?\\?\n-?0.0 -?0.0 1.2\n"));
}

TEST_F(Export, IsTheSameToTheByte) {
  ASSERT_EQ(run("export result --octomap a.ot --grid a.yaml").exit_code, 0);
  ASSERT_EQ(run("export result --octomap b.ot --grid b.yaml").exit_code, 0);
  EXPECT_TRUE(content("a.ot") == content("b.ot"));
  EXPECT_TRUE(content("a.pgm") == content("b.pgm"));
}

TEST_F(Export, RefusesWrongArguments) {
  expect_refused("", "SOURCE");
  expect_refused("result", "nothing to export");
  expect_refused("result --ply a.pcd", "--ply a.pcd: expected a name that ends in .ply");
  expect_refused("result --octomap a", "ends in .bt or .ot");
  expect_refused("result --grid a.pgm", "ends in .yaml or .yml");
  expect_refused("result --ply a.ply --ply-ascii ./a.ply", "another option names the same file");
  expect_refused("result --ply result/map.ply", "this is the input result/map.ply");
  expect_refused("result --grid result/camera.yaml", "would be overwritten");
  expect_refused("result --grid result/config.yaml", "would be overwritten");
  write("c.yaml", content("result/camera.yaml"));
  expect_refused("result --grid ./c.yaml --camera c.yaml", "this is the input c.yaml");
  std::filesystem::create_hard_link(folder_ / "result/map.ply", folder_ / "twin.ply");
  expect_refused("result --ply twin.ply", "this is the input result/map.ply");
  expect_refused("result --octomap a.bt --resolution nan", "--resolution");
  expect_refused("result --octomap a.bt --resolution 0", "--resolution");
  expect_refused("result --grid a.yaml --min-height 2", "--max-height");
  expect_refused("result --octomap a.bt --camera tum_fr9", "tum_fr9");
}

TEST_F(Export, RefusesWhatIsNoRunFolder) {
  expect_refused("nowhere --ply a.ply", "nowhere: not the folder of a finished run");
  std::filesystem::remove(folder_ / "result" / "camera.yaml");
  expect_refused("result --octomap a.bt", "camera.yaml: missing");
  EXPECT_EQ(run("export result --ply a.ply").exit_code, 0);  // needs none
  write("c.yaml", format_camera_yaml(room_.camera));
  EXPECT_EQ(run("export result --octomap a.bt --camera c.yaml").exit_code, 0);

  write("result/keyframes.txt", "1 2 3\n");
  expect_refused("result --ply b.ply", "keyframes.txt:1");
  std::filesystem::remove(folder_ / "result" / "keyframes.txt");
  expect_refused("result --ply b.ply", "keyframes.txt");
}

TEST_F(Export, RefusesABrokenOrEmptyMap) {
  write("result/map.ply", content("result/map.ply").substr(0, 5000));
  expect_refused("result --pcd a.pcd", "map.ply");
  write("result/map.ply", encode_ply({}));
  expect_refused("result --pcd a.pcd", "map.ply: no points");
}

TEST_F(Export, WritesAllFilesOrNone) {
  expect_refused("result --ply a.ply --grid none/a.yaml", "none/a.pgm");
  EXPECT_FALSE(exists("a.ply"));
  std::filesystem::create_directory(folder_ / "b.pgm");
  expect_refused("result --grid b.yaml", "b.pgm: it is a folder");
  EXPECT_FALSE(exists("b.yaml"));
}

TEST_F(Export, SaysWhenThereIsNoFloor) {
  PointCloud wall;
  add_rectangle(wall, {-1, -1, 2}, {2, 0, 0}, {0, 2, 0});
  write("result/map.ply", encode_ply(wall));
  expect_refused("result --grid a.yaml", "no floor found");
  expect_refused("result --pcd a.pcd --upright", "no floor found");
  EXPECT_FALSE(exists("a.pcd"));
  EXPECT_EQ(run("export result --octomap a.bt").exit_code, 0);  // needs none
}

TEST_F(Export, RefusesAVoxelTooSmallForTheMap) {
  PointCloud far;
  add_rectangle(far, {-500, 0, 2}, {1, 0, 0}, {0, 1, 0});
  write("result/map.ply", encode_ply(far));
  expect_refused("result --octomap a.bt --resolution 0.01", "--resolution");
}

}  // namespace
}  // namespace stillmap
