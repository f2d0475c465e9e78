// SPDX-License-Identifier: Apache-2.0
#include "simulation/scene/assets.hpp"

#include <chrono>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "simulation/scene/choreography.hpp"
#include "simulation/scene/office.hpp"
#include "stillmap/core/error.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "tests/support/files.hpp"

namespace stillmap {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(InstalledAssets, NothingIsThereInAnEmptyFolder) {
  const TemporaryFolder folder;
  EXPECT_FALSE(installed_assets(folder.path()).has_value());
  EXPECT_FALSE(installed_assets(folder.path() / "none").has_value());
}

TEST(InstalledAssets, ADamagedLibraryIsAnError) {
  const TemporaryFolder folder;
  write_file_atomically(folder.path() / "Reallusion.sh3f", "PK no zip");
  try {
    (void)installed_assets(folder.path());
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("Reallusion.sh3f"));
  }
}

class FurniturePackage : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!assets()) GTEST_SKIP() << "needs the Debian package sweethome3d-furniture";
  }
  static const std::optional<Assets>& assets() {
    static const std::optional<Assets> loaded = installed_assets();
    return loaded;
  }
  static Vector3d joint(const PersonAsset& person, Joint which) {
    return person.skeleton.positions[static_cast<std::size_t>(which)];
  }
};

double bone(const PersonAsset& person, Joint from, Joint to) {
  const auto& places = person.skeleton.positions;
  return (places[static_cast<std::size_t>(to)] - places[static_cast<std::size_t>(from)]).norm();
}

// Whether a ray from the point meets the surface an odd number of times; three rays vote, as
// models have holes.
bool is_inside(const Mesh& mesh, const Vector3f& point) {
  int votes = 0;
  for (const Vector3f& ray : {Vector3f(1, 0.13F, 0.02F),
                              Vector3f(-1, 0.07F, 0.04F),
                              Vector3f(0.03F, 1, 0.05F),
                              Vector3f(0.06F, -1, 0.01F)}) {
    bool met = false;
    for (const Mesh::Triangle& t : mesh.triangles) {
      const Vector3f& a = mesh.positions[t[0]];
      Eigen::Matrix3f edges;
      edges << mesh.positions[t[1]] - a, mesh.positions[t[2]] - a, -ray;
      if (std::abs(edges.determinant()) < 1e-12F) continue;
      const Vector3f hit = edges.inverse() * (point - a);
      met = met || (hit.x() >= 0 && hit.y() >= 0 && hit.x() + hit.y() <= 1 && hit.z() > 0 &&
                    hit.z() < 0.2F);
    }
    votes += met ? 1 : 0;
  }
  return votes >= 3;
}

TEST_F(FurniturePackage, HasPeopleOfHumanSizeAndSaysWhose) {
  ASSERT_GE(assets()->people.size(), 3U);
  for (const PersonAsset& person : assets()->people) {
    Eigen::AlignedBox3f box;
    for (const Vector3f& p : person.model.mesh.positions) box.extend(p);
    EXPECT_GE(box.sizes().z(), 1.6F) << person.model.name;
    EXPECT_LE(box.sizes().z(), 1.9F) << person.model.name;
    EXPECT_LT(person.model.mesh.triangles.size(), 20000U) << person.model.name;
  }
  EXPECT_THAT(assets()->credits, AllOf(HasSubstr("Reallusion"), HasSubstr("Creative Commons")));
}

TEST_F(FurniturePackage, JointsAreInsideTheBody) {
  for (const PersonAsset& person : assets()->people) {
    EXPECT_TRUE(joint(person, Joint::kPelvis).isZero());
    for (std::size_t j = 0; j < kJoints; ++j) {
      EXPECT_TRUE(is_inside(person.model.mesh, person.skeleton.positions[j].cast<float>()))
          << person.model.name << " " << j;
    }
  }
}

TEST_F(FurniturePackage, LimbsOfBothSidesAreOfOneLength) {
  constexpr int kLeftToRightArm = 3, kLeftToRightLeg = 3;
  const auto right = [](Joint left, int by) { return static_cast<Joint>(int(left) + by); };
  for (const PersonAsset& person : assets()->people) {
    for (const auto& [from, to] : {std::pair(Joint::kLeftShoulder, Joint::kLeftElbow),
                                   std::pair(Joint::kLeftElbow, Joint::kLeftWrist)}) {
      EXPECT_NEAR(bone(person, from, to),
                  bone(person, right(from, kLeftToRightArm), right(to, kLeftToRightArm)),
                  0.05)
          << person.model.name << " " << int(from);
    }
    for (const auto& [from, to] : {std::pair(Joint::kLeftHip, Joint::kLeftKnee),
                                   std::pair(Joint::kLeftKnee, Joint::kLeftAnkle)}) {
      EXPECT_NEAR(bone(person, from, to),
                  bone(person, right(from, kLeftToRightLeg), right(to, kLeftToRightLeg)),
                  0.03)
          << person.model.name << " " << int(from);
    }
    EXPECT_GT(joint(person, Joint::kLeftHip).y(), joint(person, Joint::kRightHip).y());
  }
}

// The greatest share, over a scene, of the surface's edges that are stretched more than 2.5 times.
double worst_share_stretched(const Assets* assets, Activity activity, std::uint32_t seed) {
  World office = make_office(1);
  add_people(office, activity, seed, assets);
  const Choreography choreography(office, activity);
  double worst = 0;
  for (double t_s = 0; t_s < 9.0; t_s += 0.75) {
    const WorldState state = choreography.at(t_s);
    for (std::size_t i = 0; i < office.people.size(); ++i) {
      const Mesh& rest = office.people[i].body.rest();
      const PosedSurface posed = office.people[i].body.posed(state.people[i]);
      std::size_t edges = 0, stretched = 0;
      for (const Mesh::Triangle& t : rest.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
          const std::uint32_t a = t[k], b = t[(k + 1) % 3];
          const float length = (rest.positions[a] - rest.positions[b]).norm();
          const float now = (posed.positions[a] - posed.positions[b]).norm();
          ++edges;
          // Of short edges even a small gap is a multiple.
          if (now > 2.5F * length && now - length > 0.03F) ++stretched;
        }
      }
      worst = std::max(worst, double(stretched) / double(edges));
    }
  }
  return worst;
}

TEST_F(FurniturePackage, PeopleBendWithoutTearing) {
  EXPECT_LT(worst_share_stretched(nullptr, Activity::kWalking, 0), 0.002);  // people made in code
  for (const Activity activity : {Activity::kWalking, Activity::kSitting}) {
    for (std::uint32_t seed = 0; seed < assets()->people.size(); ++seed) {
      const double share = worst_share_stretched(&*assets(), activity, seed);
      RecordProperty(fmt::format("share_ppm_{}_{}", int(activity), seed), int(1e6 * share));
      EXPECT_LT(share, 0.002) << int(activity) << " " << seed;
    }
  }
}

TEST_F(FurniturePackage, ChairsKeepTheirPlaceAndHeight) {
  ASSERT_FALSE(assets()->chairs.empty());
  const World plain = make_office(2), furnished = make_office(2, &*assets());
  ASSERT_EQ(plain.things.size(), furnished.things.size());
  for (std::size_t i = 0; i < plain.things.size(); ++i) {
    const Thing &a = plain.things[i], &b = furnished.things[i];
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.id, b.id);
    EXPECT_TRUE(a.T_world_thing.matrix() == b.T_world_thing.matrix());
    if (a.class_name != "chair") {
      EXPECT_EQ(a.mesh.positions, b.mesh.positions) << a.name;
      continue;
    }
    Eigen::AlignedBox3f box;
    for (const Vector3f& p : b.mesh.positions) box.extend(p);
    EXPECT_NEAR(box.max().z(), 0.92F, 0.001F) << b.name;
    EXPECT_NEAR(box.min().z(), 0.F, 0.001F) << b.name;
    EXPECT_LT(box.sizes().head<2>().maxCoeff(), 0.7F) << b.name;
  }
}

TEST_F(FurniturePackage, LoadsFastAndAlwaysTheSame) {
  const auto start = std::chrono::steady_clock::now();
  const std::optional<Assets> again = installed_assets();
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  RecordProperty("load_ms", int(1000 * took.count()));
#ifdef NDEBUG
  EXPECT_LT(took.count(), 2.0);
#endif
  ASSERT_EQ(again->people.size(), assets()->people.size());
  for (std::size_t i = 0; i < again->people.size(); ++i) {
    EXPECT_EQ(again->people[i].model.mesh.positions, assets()->people[i].model.mesh.positions);
    EXPECT_EQ(again->people[i].skeleton.positions, assets()->people[i].skeleton.positions);
  }
}

}  // namespace
}  // namespace stillmap
