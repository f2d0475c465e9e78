// SPDX-License-Identifier: Apache-2.0
#include "simulation/scene/person_shape.hpp"

#include <cmath>
#include <map>
#include <tuple>

#include "simulation/scene/person_paint.hpp"

namespace stillmap {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr float kCell_m = 0.021F;
constexpr float kPi = 3.14159265F;

struct PersonMaterials {
  MaterialId skin, face, hair, trunk, sleeves, trousers, belt, shoes, soles;
};

PersonMaterials add_materials(const PersonLook& look, MaterialLibrary& library) {
  const auto repeating = [&](const cv::Mat3b& picture) {
    return library.add({MipTexture(picture), true});
  };
  PersonMaterials ids{};
  ids.skin = repeating(paint_skin(look));
  ids.face = library.add({MipTexture(paint_face(look))});
  ids.hair = repeating(paint_hair(look));
  ids.trunk = library.add({MipTexture(paint_trunk(look))});
  ids.sleeves = repeating(paint_cloth(look));
  ids.trousers = repeating(paint_trousers(look));
  ids.belt = library.add_plain({52, 36, 26});
  ids.shoes = library.add_plain(look.shoe_color);
  ids.soles = library.add_plain({30, 29, 28});
  return ids;
}

// A cylinder around which a picture is wrapped, with the seam at its back.
struct Wrap {
  Vector3f origin;
  Vector3f axis;   // up
  Vector3f front;  // opposite to the seam
  float radius;

  [[nodiscard]] float angle(const Vector3f& p) const {
    const Vector3f out = p - origin;
    return std::atan2(out.dot(axis.cross(front)), out.dot(front));
  }
};

std::array<Wrap, kPersonCharts> wraps_of(const Skeleton& skeleton) {
  const auto limb = [&](Joint from, Joint to, float radius) {
    const Vector3f a = skeleton.positions[static_cast<std::size_t>(from)].cast<float>();
    const Vector3f b = skeleton.positions[static_cast<std::size_t>(to)].cast<float>();
    const Vector3f axis = (a - b).normalized();
    const Vector3f front = (Vector3f::UnitX() - axis.x() * axis).normalized();
    return Wrap{a, axis, front, radius};
  };
  const Wrap trunk{Vector3f::Zero(), Vector3f::UnitZ(), Vector3f::UnitX(), 0.14F};
  return {trunk,
          limb(Joint::kLeftShoulder, Joint::kLeftWrist, 0.05F),
          limb(Joint::kRightShoulder, Joint::kRightWrist, 0.05F),
          limb(Joint::kLeftHip, Joint::kLeftAnkle, 0.07F),
          limb(Joint::kRightHip, Joint::kRightAnkle, 0.07F),
          trunk};
}

// The data for painting a person's triangles.
class PersonPainter {
 public:
  PersonPainter(const PersonLook& look, const PersonMaterials& ids)
      : scale_(static_cast<float>(look.height_m / 1.75)),
        floor_(-static_cast<float>(rest_pelvis_height(look))),
        ids_(ids),
        wraps_(wraps_of(person_skeleton(look))) {}

  [[nodiscard]] MaterialId material(const FleshSample& flesh,
                                    const Vector3f& p,
                                    const Vector3f& n) const {
    const float z = p.z() / scale_;
    const bool trunk = flesh.chart == static_cast<std::uint8_t>(PersonChart::kTrunk);
    switch (static_cast<PersonLayer>(flesh.layer)) {
      case PersonLayer::kSkin: {
        const bool head = flesh.chart == static_cast<std::uint8_t>(PersonChart::kHead);
        return head && n.x() > 0.12F && z > 0.56F && p.x() > 0.02F * scale_ ? ids_.face : ids_.skin;
      }
      case PersonLayer::kShirt:
        return trunk ? ids_.trunk : ids_.sleeves;
      case PersonLayer::kTrousers:
        return trunk && z > 0.022F ? ids_.belt : ids_.trousers;
      case PersonLayer::kShoes:
        return p.z() < floor_ + 0.022F ? ids_.soles : ids_.shoes;
      case PersonLayer::kHair:
        break;
    }
    return ids_.hair;
  }

  [[nodiscard]] const Wrap& wrap(std::uint8_t chart) const { return wraps_[chart]; }

  // Place on the picture; `angle` about the chart's cylinder.
  [[nodiscard]] Vector2f uv(MaterialId id, const Wrap& wrap, const Vector3f& p, float angle) const {
    if (id == ids_.face) {
      const Vector3f q = p / scale_;
      return {0.5F + q.y() / kFaceWidth_m, (kFaceTop_m - q.z()) / kFaceHeight_m};
    }
    if (id == ids_.trunk) {
      return {0.5F + angle / (2.F * kPi),
              (kTrunkTop_m - p.z() / scale_) / (kTrunkTop_m - kTrunkBottom_m)};
    }
    return {angle * wrap.radius / kClothTile_m, -(p - wrap.origin).dot(wrap.axis) / kClothTile_m};
  }

 private:
  float scale_;
  float floor_;
  PersonMaterials ids_;
  std::array<Wrap, kPersonCharts> wraps_;
};

// Gives each triangle its material and each corner its texture coordinates; a corner between two
// pictures, or at a seam, is duplicated.
Mesh painted(const FleshSurface& surface, const Flesh& flesh, const PersonPainter& painter) {
  using Key = std::tuple<std::uint32_t, MaterialId, std::uint8_t, bool>;
  std::map<Key, std::uint32_t> corners;
  Mesh mesh;
  for (const Mesh::Triangle& t : surface.triangles) {
    Vector3f middle = Vector3f::Zero();
    Vector3f normal = Vector3f::Zero();
    for (const std::uint32_t corner : t) {
      middle += surface.positions[corner] / 3.F;
      normal += surface.normals[corner] / 3.F;
    }
    const FleshSample at = flesh.sample(middle);
    const MaterialId id = painter.material(at, middle, normal);
    const Wrap& wrap = painter.wrap(at.chart);
    const float angle = wrap.angle(middle);
    Mesh::Triangle painted_triangle{};
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector3f& p = surface.positions[t[i]];
      float own = wrap.angle(p);
      if (own < angle - kPi) own += 2.F * kPi;
      if (own > angle + kPi) own -= 2.F * kPi;
      const Key key{t[i], id, at.chart, std::abs(own) > kPi};
      const auto [place, is_new] =
          corners.try_emplace(key, static_cast<std::uint32_t>(mesh.positions.size()));
      if (is_new) {
        mesh.positions.push_back(p);
        mesh.normals.push_back(surface.normals[t[i]]);
        mesh.uvs.push_back(painter.uv(id, wrap, p, own));
      }
      painted_triangle[i] = place->second;
    }
    mesh.triangles.push_back(painted_triangle);
    mesh.materials.push_back(id);
  }
  return mesh;
}

}  // namespace

Body make_person(const PersonLook& look, MaterialLibrary& materials) {
  const float scale = static_cast<float>(look.height_m / 1.75);
  const Flesh flesh = person_flesh(look);
  const Vector3f half(0.24F, 0.50F, 0.F);
  const FleshSurface surface = surface_of(flesh,
                                          scale * (-half - Vector3f(0, 0, 1.00F)),
                                          scale * (half + Vector3f(0, 0, 0.86F)),
                                          kCell_m);
  const PersonPainter painter(look, add_materials(look, materials));
  return Body(painted(surface, flesh, painter), person_skeleton(look));
}

}  // namespace stillmap
