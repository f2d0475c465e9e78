// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "simulation/scene/person_shape.hpp"

namespace stillmap {
namespace {

using Eigen::Vector3f;

constexpr double kModelHeight = 1.75;
constexpr float kModelPelvisHeight = 0.96F;
constexpr float kArmAngle = 0.314F;  // off the trunk at rest

constexpr std::size_t index(Joint joint) {
  return static_cast<std::size_t>(joint);
}

// The side of a limb, for parts common to left and right.
struct Side {
  float y;  // +1 left, -1 right
  PersonChart arm;
  PersonChart leg;
  [[nodiscard]] Vector3f at(float x, float lateral, float z) const { return {x, y * lateral, z}; }
};

constexpr Side kLeft{1.F, PersonChart::kLeftArm, PersonChart::kLeftLeg};
constexpr Side kRight{-1.F, PersonChart::kRightArm, PersonChart::kRightLeg};

// Builds the parts for a height of 1.75 m; they are scaled at the end.
class Builder {
 public:
  explicit Builder(const PersonLook& look)
      : look_(look), girth_(float(look.girth)), feminine_(float(look.feminine)) {}

  void wear(PersonLayer layer, PersonChart chart, float blend_m) {
    layer_ = layer;
    chart_ = chart;
    blend_ = blend_m;
  }

  FleshPart& cone(const Vector3f& from, const Vector3f& to, float from_radius, float to_radius) {
    FleshPart part;
    part.from = from;
    part.to = to;
    part.from_radius = from_radius;
    part.to_radius = to_radius;
    part.layer = static_cast<std::uint8_t>(layer_);
    part.chart = static_cast<std::uint8_t>(chart_);
    part.blend_m = blend_;
    parts_.push_back(part);
    return parts_.back();
  }

  // A cone that is `depth` times as deep (along x) as it is wide.
  FleshPart& flat_cone(
      const Vector3f& from, const Vector3f& to, float from_radius, float to_radius, float depth) {
    FleshPart& part = cone(from, to, from_radius, to_radius);
    part.squeeze = Vector3f(1.F / depth, 1.F, 1.F).asDiagonal();
    return part;
  }

  FleshPart& ellipsoid(const Vector3f& center, const Vector3f& half) {
    FleshPart& part = cone(center, center, half.y(), half.y());
    part.squeeze = (half.y() * half.cwiseInverse()).asDiagonal();
    return part;
  }

  [[nodiscard]] float girth() const { return girth_; }
  [[nodiscard]] float feminine() const { return feminine_; }
  [[nodiscard]] const PersonLook& look() const { return look_; }
  [[nodiscard]] float shoulder_y() const { return 0.188F - 0.018F * feminine_; }

  [[nodiscard]] std::vector<FleshPart> scaled_parts() const {
    const float scale = static_cast<float>(look_.height_m / kModelHeight);
    std::vector<FleshPart> parts = parts_;
    for (FleshPart& part : parts) {
      part.from *= scale;
      part.to *= scale;
      part.from_radius *= scale;
      part.to_radius *= scale;
    }
    return parts;
  }

 private:
  const PersonLook& look_;
  float girth_;
  float feminine_;
  PersonLayer layer_ = PersonLayer::kSkin;
  PersonChart chart_ = PersonChart::kTrunk;
  float blend_ = 0.03F;
  std::vector<FleshPart> parts_;
};

Vector3f arm_direction(const Side& side) {
  return side.at(0, std::sin(kArmAngle), -std::cos(kArmAngle));
}

void add_head(Builder& b) {
  b.wear(PersonLayer::kSkin, PersonChart::kHead, 0.02F);
  b.ellipsoid({0.008F, 0, 0.688F}, {0.094F, 0.074F, 0.096F});
  b.ellipsoid({0.046F, 0, 0.628F}, {0.056F, 0.053F - 0.004F * b.feminine(), 0.058F});  // jaw
  b.ellipsoid({0.082F, 0, 0.585F}, {0.020F, 0.022F, 0.018F});                          // chin
  b.ellipsoid({0.086F, 0, 0.712F}, {0.016F, 0.050F, 0.014F});                          // brows
  for (const Side& side : {kLeft, kRight}) {
    b.ellipsoid(side.at(0.076F, 0.036F, 0.655F), {0.020F, 0.022F, 0.020F});  // cheeks
  }
  b.wear(PersonLayer::kSkin, PersonChart::kHead, 0.012F);
  b.cone({0.100F, 0, 0.690F}, {0.118F, 0, 0.650F}, 0.009F, 0.014F);  // nose
  for (const Side& side : {kLeft, kRight}) {
    b.ellipsoid(side.at(0.0F, 0.078F, 0.665F), {0.022F, 0.012F, 0.032F});
  }
  const float thin = 1.F - 0.14F * b.feminine();
  b.wear(PersonLayer::kSkin, PersonChart::kHead, 0.025F);
  b.cone({-0.018F, 0, 0.46F}, {0.0F, 0, 0.61F}, 0.062F * thin, 0.056F * thin);
}

void add_hair(Builder& b) {
  b.wear(PersonLayer::kHair, PersonChart::kHead, 0.02F);
  const HairStyle style = b.look().hair;
  const float thick = style == HairStyle::kCrop ? 0.004F : 0.012F;
  // The crown, and the back of the head down to the nape.
  b.ellipsoid({-0.004F, 0, 0.712F}, {0.096F + thick, 0.076F + thick, 0.080F + thick});
  b.ellipsoid({-0.045F, 0, 0.670F}, {0.058F + thick, 0.070F + thick, 0.075F + thick});
  if (style == HairStyle::kShort) b.ellipsoid({0.055F, 0.015F, 0.765F}, {0.048F, 0.055F, 0.030F});
  if (style == HairStyle::kBun) b.ellipsoid({-0.120F, 0, 0.735F}, {0.046F, 0.046F, 0.046F});
  if (style != HairStyle::kBob && style != HairStyle::kLong) return;
  const float end = style == HairStyle::kBob ? 0.585F : 0.43F;
  b.flat_cone({-0.045F, 0, 0.68F}, {-0.088F, 0, end}, 0.094F, 0.100F, 0.55F).flat_end = true;
  for (const Side& side : {kLeft, kRight}) {
    b.cone(side.at(-0.005F, 0.072F, 0.70F), side.at(-0.03F, 0.088F, end + 0.02F), 0.030F, 0.026F);
  }
}

void add_trunk(Builder& b) {
  const float g = b.girth();
  const float f = b.feminine();
  b.wear(PersonLayer::kShirt, PersonChart::kTrunk, 0.05F);
  const float chest = 0.152F - 0.014F * f + 0.04F * (g - 1.F);
  b.flat_cone({-0.014F, 0, 0.365F}, {0.0F, 0, 0.20F}, chest, chest - 0.006F - 0.012F * f, 0.74F);
  const float waist = (0.141F - 0.016F * f) * g;
  const float hem = (0.148F + 0.010F * f) * g;
  b.flat_cone({0.0F, 0, 0.22F}, {0.003F, 0, 0.07F}, chest - 0.008F, waist, 0.76F);
  if (g > 1.05F) b.ellipsoid({0.06F, 0, 0.11F}, {0.085F * g, 0.10F, 0.10F});
  if (b.look().tucked_in) {
    const Vector3f belt(-0.003F, 0, 0.055F);
    b.flat_cone({0.003F, 0, 0.10F}, belt, waist, hem + 0.012F, 0.80F).flat_end = true;
  } else {  // the shirt hangs over hips and seat
    const float width = 0.109F + 0.086F * std::sqrt(g);
    const float depth = 0.69F + 0.35F * std::max(g - 1.F, 0.F);
    const Vector3f hips(-0.016F, 0, -0.01F);
    b.wear(PersonLayer::kShirt, PersonChart::kTrunk, 0.015F);
    b.flat_cone({0.0F, 0, 0.14F}, hips, waist, width, depth);
    b.flat_cone(hips, {-0.017F, 0, -0.065F}, width, width, depth).flat_end = true;
    b.wear(PersonLayer::kShirt, PersonChart::kTrunk, 0.05F);
  }
  for (const Side& side : {kLeft, kRight}) {
    b.cone(side.at(-0.016F, 0.05F, 0.452F),
           side.at(-0.01F, b.shoulder_y() - 0.01F, 0.428F),
           0.052F,
           0.055F);
    const float bust = 0.050F + 0.010F * f;
    b.ellipsoid(side.at(0.070F + 0.014F * f, 0.066F, 0.315F), {bust, bust + 0.008F, bust});
    b.ellipsoid(side.at(-0.070F, 0.075F, 0.36F), {0.05F, 0.07F, 0.09F});  // shoulder blades
  }
}

void add_arm(Builder& b, const Side& side) {
  const Vector3f along = arm_direction(side);
  const Vector3f shoulder = side.at(-0.01F, b.shoulder_y(), 0.42F);
  const Vector3f elbow = shoulder + 0.285F * along;
  const Vector3f wrist = elbow + 0.250F * along;
  const float slim = 1.F - 0.12F * b.feminine();
  b.wear(PersonLayer::kSkin, side.arm, 0.015F);
  b.cone(shoulder, elbow, 0.047F * slim, 0.040F * slim);
  b.cone(elbow + 0.05F * along, wrist, 0.041F * slim, 0.028F * slim);
  // Palms face the thighs: hands are flat across the body's y axis, turned with the arm.
  const Eigen::AngleAxisf turn(side.y * kArmAngle, Vector3f::UnitX());
  const Eigen::Matrix3f upright = turn.toRotationMatrix().transpose();
  const auto hand_part = [&](float ahead, const Vector3f& half) {
    FleshPart& part = b.ellipsoid(wrist + ahead * along, half);
    part.squeeze = part.squeeze * upright;
  };
  hand_part(0.050F, {0.040F, 0.020F, 0.055F});
  hand_part(0.115F, {0.035F, 0.016F, 0.058F});
  b.cone(wrist + 0.03F * along + Vector3f(0.02F, 0, 0),
         wrist + 0.075F * along + Vector3f(0.058F, 0, 0),
         0.014F,
         0.012F);
  b.wear(PersonLayer::kShirt, side.arm, 0.035F);
  const bool sleeves = b.look().long_sleeves;
  const Vector3f cuff =
      sleeves ? Vector3f(wrist - 0.005F * along) : Vector3f(elbow - 0.05F * along);
  const float wide = sleeves ? 0.050F * slim : 0.056F * slim;
  if (sleeves) {
    b.cone(shoulder, elbow, 0.058F * slim, wide);
    b.cone(elbow, cuff, wide, 0.038F).flat_end = true;
  } else {
    b.cone(shoulder, cuff, 0.058F * slim, wide).flat_end = true;
  }
}

void add_legs(Builder& b) {
  const float g = b.girth();
  const float f = b.feminine();
  b.wear(PersonLayer::kTrousers, PersonChart::kTrunk, 0.03F);
  const float hips = (0.144F + 0.010F * f) * std::sqrt(g);
  FleshPart& top =
      b.flat_cone({-0.003F, 0, -0.04F}, {0.0F, 0, 0.075F}, hips, (0.140F - 0.008F * f) * g, 0.78F);
  top.flat_end = true;
  for (const Side& side : {kLeft, kRight}) {
    b.wear(PersonLayer::kTrousers, PersonChart::kTrunk, 0.03F);
    b.ellipsoid(side.at(-0.055F, 0.066F, -0.055F), {0.072F, 0.076F + 0.006F * f, 0.080F});
    b.wear(PersonLayer::kTrousers, side.leg, 0.02F);
    const Vector3f hip = side.at(0, 0.092F, -0.05F);
    const Vector3f knee = side.at(0, 0.108F, -0.48F);
    const Vector3f ankle = side.at(-0.02F, 0.118F, -0.88F);
    const float thick = std::sqrt(g);
    b.cone(hip, knee, 0.086F * thick, 0.064F);
    b.cone(knee, side.at(-0.030F, 0.114F, -0.64F), 0.063F, 0.060F);
    b.cone(side.at(-0.028F, 0.113F, -0.62F), ankle + Vector3f(0, 0, 0.005F), 0.061F, 0.053F)
        .flat_end = true;
    b.wear(PersonLayer::kShoes, side.leg, 0.03F);
    b.cone(ankle + Vector3f(0, 0, 0.06F), ankle, 0.040F, 0.040F);
    const float heel = ankle.x() - 0.030F;
    const auto shoe = [&](float from, float to, float from_radius, float to_radius) {
      FleshPart& part =
          b.cone(Vector3f(from, ankle.y(), -0.960F + 0.7F * from_radius),
                 Vector3f(to, ankle.y() + side.y * 0.008F, -0.960F + 0.7F * to_radius),
                 from_radius,
                 to_radius);
      part.squeeze = Vector3f(1.F, 1.F, 1.F / 0.7F).asDiagonal();
    };
    shoe(heel, heel + 0.09F, 0.042F, 0.044F);
    shoe(heel + 0.09F, heel + 0.185F, 0.046F, 0.042F);
    b.cone(Vector3f(heel + 0.03F, ankle.y(), -0.90F),
           Vector3f(heel + 0.12F, ankle.y(), -0.925F),
           0.040F,
           0.030F);
  }
}

}  // namespace

double rest_pelvis_height(const PersonLook& look) {
  return double(kModelPelvisHeight) * look.height_m / kModelHeight;
}

Skeleton person_skeleton(const PersonLook& look) {
  const Builder b(look);
  Skeleton skeleton;
  const float scale = static_cast<float>(look.height_m / kModelHeight);
  const auto place = [&](Joint joint, const Vector3f& at) {
    skeleton.positions[index(joint)] = (scale * at).cast<double>();
  };
  place(Joint::kPelvis, Vector3f::Zero());
  place(Joint::kSpine, {-0.01F, 0, 0.10F});
  place(Joint::kChest, {-0.012F, 0, 0.26F});
  place(Joint::kNeck, {-0.018F, 0, 0.48F});
  place(Joint::kHead, {0.0F, 0, 0.59F});
  const auto place_limbs = [&](const Side& side, Joint shoulder, Joint hip) {
    const Vector3f at = side.at(-0.01F, b.shoulder_y(), 0.42F);
    const auto next = [](Joint joint, int by) { return static_cast<Joint>(int(joint) + by); };
    place(shoulder, at);
    place(next(shoulder, 1), at + 0.285F * arm_direction(side));
    place(next(shoulder, 2), at + 0.535F * arm_direction(side));
    place(hip, side.at(0, 0.092F, -0.05F));
    place(next(hip, 1), side.at(0, 0.108F, -0.48F));
    place(next(hip, 2), side.at(-0.02F, 0.118F, -0.88F));
  };
  place_limbs(kLeft, Joint::kLeftShoulder, Joint::kLeftHip);
  place_limbs(kRight, Joint::kRightShoulder, Joint::kRightHip);
  return skeleton;
}

Flesh person_flesh(const PersonLook& look) {
  Builder b(look);
  add_head(b);
  add_hair(b);
  add_trunk(b);
  add_arm(b, kLeft);
  add_arm(b, kRight);
  add_legs(b);
  return Flesh(b.scaled_parts());
}

}  // namespace stillmap
