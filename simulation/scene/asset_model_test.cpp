// SPDX-License-Identifier: Apache-2.0
#include "simulation/scene/asset_model.hpp"

#include <map>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zip.h>

#include "stillmap/core/error.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "stillmap/io/image_io.hpp"
#include "tests/support/files.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3f;
using ::testing::AllOf;
using ::testing::HasSubstr;

using Entries = std::map<std::string, std::string>;

// A cube of side 2 whose front (z = 1) bears a picture; the rest is red.
const char* const kCube =
    "mtllib cube.mtl\n"
    "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n"
    "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
    "usemtl painted\nf 5/1 6/2 7/3 8/4\n"
    "usemtl red\nf 1 4 3 2\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
const char* const kCubeMaterials =
    "newmtl painted\nKd 1 1 1\nmap_Kd front.png\nnewmtl red\nKd 1 0 0\n";
const char* const kCatalogue =
    "# a comment\nid=Test\nid#1=Test#cube\nname#1=Cube\nmodel#1=/test/cube/cube.obj\n"
    "width#1=40\ndepth#1=20\nheight#1=80.5\n";

// Its upper half is green, its lower half blue.
std::string two_colors() {
  cv::Mat3b picture(2, 2);
  picture.row(0) = cv::Vec3b(0, 255, 0);
  picture.row(1) = cv::Vec3b(0, 0, 255);
  return encode_png(ColorImage(picture));
}

Entries cube_entries() {
  return {{"PluginFurnitureCatalog.properties", kCatalogue},
          {"test/cube/cube.obj", kCube},
          {"test/cube/cube.mtl", kCubeMaterials},
          {"test/cube/front.png", two_colors()}};
}

fs::path write_zip(const TemporaryFolder& folder, const Entries& entries) {
  const fs::path path = folder.path() / "Test.sh3f";
  int code = 0;
  zip_t* zip = zip_open(path.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &code);
  STILLMAP_CHECK(zip != nullptr);
  for (const auto& [name, bytes] : entries) {
    zip_source_t* source = zip_source_buffer(zip, bytes.data(), bytes.size(), 0);
    STILLMAP_CHECK(zip_file_add(zip, name.c_str(), source, 0) >= 0);
  }
  STILLMAP_CHECK(zip_close(zip) == 0);
  return path;
}

AssetModel load_cube(const Entries& entries) {
  const TemporaryFolder folder;
  const AssetArchive archive(write_zip(folder, entries));
  return load_model(archive, archive.model("cube"));
}

// The error of loading; empty if there is none.
std::string complaint(const Entries& entries) {
  try {
    (void)load_cube(entries);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(AssetModel, HasTheCataloguesSizeAndAxes) {
  const AssetModel cube = load_cube(cube_entries());
  Eigen::AlignedBox3f box;
  for (const Vector3f& p : cube.mesh.positions) box.extend(p);
  EXPECT_LT((box.min() - Vector3f(-0.1F, -0.2F, 0.F)).norm(), 1e-6F);
  EXPECT_LT((box.max() - Vector3f(0.1F, 0.2F, 0.805F)).norm(), 1e-6F);
  EXPECT_EQ(cube.mesh.triangles.size(), 12U);
  EXPECT_EQ(cube.mesh.positions.size(), 24U);  // edges are sharp: four corners a face
}

TEST(AssetModel, FacesOutwardsAndKnowsItsNormals) {
  const AssetModel cube = load_cube(cube_entries());
  for (const Mesh::Triangle& t : cube.mesh.triangles) {
    const Vector3f a = cube.mesh.positions[t[0]];
    const Vector3f normal =
        (cube.mesh.positions[t[1]] - a).cross(cube.mesh.positions[t[2]] - a).normalized();
    EXPECT_GT(normal.dot(a - Vector3f(0, 0, 0.4025F)), 0.F);
    for (const std::uint32_t c : t) EXPECT_GT(normal.dot(cube.mesh.normals[c]), 0.999F);
  }
}

TEST(AssetModel, ItsPictureIsOnItsFrontTheRightWayUp) {
  const AssetModel cube = load_cube(cube_entries());
  int painted = 0;
  for (std::size_t t = 0; t < cube.mesh.triangles.size(); ++t) {
    const Material& material = cube.materials[cube.mesh.materials[t]];
    const bool front = cube.mesh.normals[cube.mesh.triangles[t][0]].x() > 0.9F;
    painted += front ? 1 : 0;
    for (const std::uint32_t c : cube.mesh.triangles[t]) {
      const Eigen::Vector2f& uv = cube.mesh.uvs[c];
      const TexelSum rgb = material.texture.sample({uv.x(), uv.y()}, -1.F);
      const bool upper = cube.mesh.positions[c].z() > 0.4F;
      EXPECT_EQ(rgb[0] >> 8U, front ? 0U : 255U);
      EXPECT_EQ(rgb[1] >> 8U, front && upper ? 255U : 0U);
      EXPECT_EQ(rgb[2] >> 8U, front && !upper ? 255U : 0U);
    }
    EXPECT_FALSE(material.repeats);
  }
  EXPECT_EQ(painted, 2);
}

TEST(AssetModel, PicturesRepeatWhereTheirPlacesGoBeyond) {
  Entries entries = cube_entries();
  std::string& object = entries["test/cube/cube.obj"];
  object.replace(object.find("vt 1 1"), 6, "vt 3 1");
  const AssetModel cube = load_cube(entries);
  EXPECT_TRUE(cube.materials[0].repeats);
  EXPECT_FALSE(cube.materials[1].repeats);
}

TEST(AssetModel, IsTurnedAsTheCatalogueSays) {
  Entries entries = cube_entries();
  entries["PluginFurnitureCatalog.properties"] += "modelRotation#1=-1 0 0 0 1 0 0 0 -1\n";
  const AssetModel cube = load_cube(entries);
  const Mesh::Triangle& painted = cube.mesh.triangles.front();
  EXPECT_LT(cube.mesh.normals[painted[0]].x(), -0.9F);
}

TEST(AssetModel, BothSidesOfATriangleAreOne) {
  Entries entries = cube_entries();
  entries["test/cube/cube.obj"] += "f 1 3 6\nf 6 3 1\n";
  const std::size_t triangles = load_cube(entries).mesh.triangles.size();
  EXPECT_EQ(triangles, 13U);
}

TEST(AssetModel, IsAddedToAWorldWithItsMaterials) {
  const AssetModel cube = load_cube(cube_entries());
  MaterialLibrary materials;
  materials.add_plain({1, 2, 3});
  const Mesh mesh = add_model(cube, materials);
  EXPECT_EQ(materials.size(), 1 + cube.materials.size());
  for (std::size_t t = 0; t < mesh.materials.size(); ++t) {
    EXPECT_EQ(mesh.materials[t], cube.mesh.materials[t] + 1);
  }
}

TEST(AssetModel, SaysWhatIsMissing) {
  for (const char* name : {"test/cube/cube.obj", "test/cube/cube.mtl", "test/cube/front.png"}) {
    Entries entries = cube_entries();
    entries.erase(name);
    EXPECT_THAT(complaint(entries), AllOf(HasSubstr("Test.sh3f"), HasSubstr(name))) << name;
  }
  EXPECT_EQ(complaint(cube_entries()), "");
}

TEST(AssetModel, DoesNotLeaveTheArchive) {
  for (const char* name : {"../../etc/secret.png", "a/../../front.png", "a\\front.png"}) {
    Entries entries = cube_entries();
    entries["test/cube/cube.mtl"] = fmt::format("newmtl painted\nmap_Kd {}\nnewmtl red\n", name);
    entries[fmt::format("test/cube/{}", name)] = two_colors();
    EXPECT_THAT(complaint(entries), HasSubstr("leads out of the archive")) << name;
  }
}

TEST(AssetModel, RefusesBrokenContent) {
  const std::vector<std::pair<std::string, std::string>> broken = {
      {"test/cube/front.png", "no picture"},
      {"test/cube/front.png", two_colors().substr(0, 40)},
      {"test/cube/cube.obj", "mtllib cube.mtl\nv 0 0 0\n"},
      {"test/cube/cube.obj", "v 0 0 0\nv 1 0 0\nv 0 1 1\nf 1 2 9\n"},
      {"test/cube/cube.obj", "v 1e39 0 0\nv 1 0 0\nv 0 1 1\nf 1 2 3\n"},
      {"test/cube/cube.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"}};
  for (const auto& [name, content] : broken) {
    Entries entries = cube_entries();
    entries[name] = content;
    EXPECT_THAT(complaint(entries), AllOf(HasSubstr("Test.sh3f"), HasSubstr(name))) << content;
  }
}

TEST(AssetArchive, RefusesACatalogueWithoutSense) {
  for (const char* size : {"width#1=0", "width#1=nan", "width#1=-4", "width#1=1e9", "width#1=x"}) {
    Entries entries = cube_entries();
    std::string& catalogue = entries["PluginFurnitureCatalog.properties"];
    catalogue.replace(catalogue.find("width#1=40"), 10, size);
    EXPECT_THAT(complaint(entries), HasSubstr("width#1")) << size;
  }
  Entries entries = cube_entries();
  entries.erase("PluginFurnitureCatalog.properties");
  EXPECT_THAT(complaint(entries), HasSubstr("PluginFurnitureCatalog.properties"));
}

TEST(AssetArchive, NamesWhatItDoesNotList) {
  const TemporaryFolder folder;
  const AssetArchive archive(write_zip(folder, cube_entries()));
  EXPECT_THROW((void)archive.model("sphere"), Error);
  EXPECT_TRUE(archive.contains("test/cube/cube.obj"));
  EXPECT_FALSE(archive.contains("test/cube/cube.obj2"));
}

TEST(AssetArchive, RefusesEntriesOverALimitBeforeUnpackingThem) {
  const TemporaryFolder folder;
  Entries entries = cube_entries();
  entries["bomb"] = std::string(8U << 20U, '\0');
  const fs::path path = write_zip(folder, entries);
  EXPECT_LT(fs::file_size(path), 64U << 10U);
  const AssetArchive archive(path);
  EXPECT_EQ(archive.read("bomb", 8U << 20U).size(), 8U << 20U);
  EXPECT_THROW((void)archive.read("bomb", (8U << 20U) - 1), Error);
}

// Any wrong byte gives an Error, unless the file's checksums do not cover it.
TEST(AssetArchive, DamageIsAnError) {
  const TemporaryFolder folder;
  const fs::path path = write_zip(folder, cube_entries());
  const std::string good = read_file(path, 1U << 20U);
  int errors = 0, loads = 0;
  for (std::size_t at = 0; at < good.size(); at += 7) {
    for (const bool truncated : {false, true}) {
      std::string bad = good;
      bad[at] = static_cast<char>(bad[at] ^ 0x55);
      if (truncated) bad.resize(at);
      write_file_atomically(path, bad);
      try {
        const AssetArchive archive(path);
        (void)load_model(archive, archive.model("cube"));
        ++loads;
        EXPECT_FALSE(truncated) << at;
      } catch (const Error& error) {
        ++errors;
        EXPECT_THAT(error.what(), HasSubstr("Test.sh3f"));
      }
    }
  }
  EXPECT_GT(errors, 2 * loads);
}

}  // namespace
}  // namespace stillmap
