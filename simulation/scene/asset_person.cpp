// SPDX-License-Identifier: Apache-2.0
#include "simulation/scene/asset_person.hpp"

#include <string_view>

namespace stillmap {
namespace {

using Eigen::Vector3d;

// A place in a model in centimetres: to the person's left, up from the floor, to the front, from
// the middle of the model's extent.
struct BodyPlace {
  double left;
  double up;
  double front;
};

// The joints of both sides, from the trunk outwards.
struct LimbPlaces {
  BodyPlace root;
  BodyPlace middle;
  BodyPlace end;
};

// The joints of a model, measured in slices of it at the heights of the joints of a human of that
// size.
struct FittedModel {
  std::string_view name;
  double height_m;  // target height; some models are of youths
  BodyPlace spine, chest, neck, head;
  LimbPlaces left_arm, right_arm, left_leg, right_leg;
};

constexpr std::array<FittedModel, 4> kPeople{{
    {"holdingMale01",
     1.82,
     {0, 107, -15.5},
     {-0.5, 124, -16.5},
     {-0.3, 155, -16},
     {-0.5, 165, -14.5},
     {{16, 149, -12.5}, {25.5, 124.5, -10}, {21.5, 118.5, 14}},
     {{-17, 149, -18}, {-25.5, 125, -20.5}, {-26, 101, -10.5}},
     {{9, 92, -14}, {15.3, 50, -12.5}, {19, 10, -18.5}},
     {{-9, 92, -14}, {-8.3, 50, -12.5}, {-7, 10, -20.5}}},
    {"female03",
     1.68,
     {-2.6, 101, 4.5},
     {-3.2, 115, 3.5},
     {-1.8, 137, -0.5},
     {-1.4, 146, -0.5},
     {{11.5, 132, -4}, {21.5, 108.5, -21}, {14, 95, -3.5}},
     {{-17, 132, 2.5}, {-22, 106, 3.5}, {-17.5, 87, 10.5}},
     {{4.5, 88, 2}, {-2.5, 48, -1}, {-5.9, 10, -8.6}},
     {{-9.5, 88, 9}, {-3.2, 48, 16.8}, {1, 10, 7}}},
    {"male01",
     1.84,
     {-2.3, 108, -1},
     {-2, 125, -0.5},
     {-2.4, 157, -1.5},
     {-2.6, 167, -0.5},
     {{15, 150, -0.5}, {24, 119, 0}, {6, 115, 14}},
     {{-20, 150, -0.5}, {-25, 120, -5}, {-26, 96, 0}},
     {{6.5, 92, -1}, {10.4, 52, -3.2}, {14, 11, -8}},
     {{-12, 92, -1}, {-14.3, 52, -2.6}, {-16, 11, -5}}},
    {"boyStanding",
     1.72,
     {-1.2, 97, -1},
     {-1, 112, -0.5},
     {-1.3, 135, 0.5},
     {-2, 145, 2},
     {{13, 129, -1}, {22.8, 108, -7.6}, {13, 96, 5}},
     {{-15.5, 129, -1}, {-20.5, 106, 0}, {-25, 85, 8}},
     {{7, 83, -0.7}, {8.2, 46, 0.5}, {10.2, 9, -2.5}},
     {{-9.5, 83, -0.7}, {-10.6, 46, -0.7}, {-10.9, 9, -2}}},
}};

// In metres, x to the front, y left, z up.
Vector3d in_metres(const BodyPlace& place) {
  return Vector3d(place.front, place.left, place.up) / 100.0;
}

// The pelvis joint is between the hips, 5 cm above them.
Vector3d pelvis_of(const FittedModel& model) {
  return 0.5 * (in_metres(model.left_leg.root) + in_metres(model.right_leg.root)) +
         Vector3d(0, 0, 0.05);
}

Skeleton skeleton_of(const FittedModel& model, double scale) {
  Skeleton skeleton;
  const Vector3d pelvis = pelvis_of(model);
  const auto put = [&](Joint joint, int by, const BodyPlace& place) {
    skeleton.positions[static_cast<std::size_t>(joint) + static_cast<std::size_t>(by)] =
        scale * (in_metres(place) - pelvis);
  };
  const auto put_limb = [&](Joint root, const LimbPlaces& limb) {
    put(root, 0, limb.root);
    put(root, 1, limb.middle);
    put(root, 2, limb.end);
  };
  skeleton.positions[static_cast<std::size_t>(Joint::kPelvis)].setZero();
  put(Joint::kSpine, 0, model.spine);
  put(Joint::kChest, 0, model.chest);
  put(Joint::kNeck, 0, model.neck);
  put(Joint::kHead, 0, model.head);
  put_limb(Joint::kLeftShoulder, model.left_arm);
  put_limb(Joint::kRightShoulder, model.right_arm);
  put_limb(Joint::kLeftHip, model.left_leg);
  put_limb(Joint::kRightHip, model.right_leg);
  return skeleton;
}

PersonAsset load_person(const AssetArchive& archive, const FittedModel& fitted) {
  const CatalogueEntry& entry = archive.model(std::string(fitted.name));
  const double scale = fitted.height_m / entry.height_m;
  PersonAsset person{load_model(archive, entry), skeleton_of(fitted, scale)};
  const Eigen::Vector3f pelvis = pelvis_of(fitted).cast<float>();
  for (Eigen::Vector3f& p : person.model.mesh.positions) {
    p = static_cast<float>(scale) * (p - pelvis);
  }
  return person;
}

}  // namespace

std::vector<PersonAsset> load_people(const AssetArchive& archive) {
  std::vector<PersonAsset> people;
  for (const FittedModel& fitted : kPeople) people.push_back(load_person(archive, fitted));
  return people;
}

Body make_person(const PersonAsset& asset, MaterialLibrary& materials) {
  return Body(add_model(asset.model, materials), asset.skeleton, Limbs::kTouching);
}

}  // namespace stillmap
