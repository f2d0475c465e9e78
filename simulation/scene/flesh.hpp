// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "simulation/scene/mesh.hpp"

namespace stillmap {

/// A rounded cone from `from` to `to`, stretched by `squeeze` (place -> place where it is round).
struct FleshPart {
  Eigen::Vector3f from;
  Eigen::Vector3f to;
  float from_radius = 0;
  float to_radius = 0;
  Eigen::Matrix3f squeeze = Eigen::Matrix3f::Identity();
  bool flat_end = false;   ///< cut across at `to` instead of rounded
  std::uint8_t layer = 0;  ///< parts of one layer blend smoothly, layers cover each other
  std::uint8_t chart = 0;  ///< free to use; goes with the surface nearest to the part
  float blend_m = 0.03F;   ///< width of the blend with other parts of its layer
};

/// The solid near a position.
struct FleshSample {
  float distance = 0;  ///< approximate distance to the surface; negative inside
  std::uint8_t layer = 0;
  std::uint8_t chart = 0;
};

inline constexpr std::size_t kFleshLayers = 5;

/// A solid made of soft parts.
class Flesh {
 public:
  explicit Flesh(const std::vector<FleshPart>& parts);

  [[nodiscard]] FleshSample sample(const Eigen::Vector3f& p) const;

  /// The parts that affect distances within `reach_m` of a position.
  [[nodiscard]] Flesh near(const Eigen::Vector3f& p, float reach_m) const;

  /// Unit direction in which the distance grows, at a position near the surface.
  [[nodiscard]] Eigen::Vector3f normal(const Eigen::Vector3f& p) const;

 private:
  // A part with the precomputed values for its distance.
  struct Prepared {
    FleshPart part;
    Eigen::Vector3f squeezed_from;
    Eigen::Vector3f squeezed_along;
    float inverse_length2 = 0;
    Eigen::Vector3f end_direction;

    [[nodiscard]] float distance_to(const Eigen::Vector3f& p) const;
  };

  Flesh() = default;

  std::vector<Prepared> parts_;
};

/// A closed surface.
struct FleshSurface {
  std::vector<Eigen::Vector3f> positions;
  std::vector<Eigen::Vector3f> normals;
  std::vector<Mesh::Triangle> triangles;  ///< counter-clockwise as seen from outside
};

/// The surface of a solid with corners about `cell_m` apart (surface nets). `low` and `high` are
/// corners of a box that it lies in.
[[nodiscard]] FleshSurface surface_of(const Flesh& flesh,
                                      const Eigen::Vector3f& low,
                                      const Eigen::Vector3f& high,
                                      float cell_m);

}  // namespace stillmap
