// SPDX-License-Identifier: Apache-2.0
#include "simulation/scene/flesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

constexpr float kFar = 1e3F;

// Minimum of two distances whose edge is rounded within `blend`.
float melt(float a, float b, float blend) {
  const float h = std::max(blend - std::abs(a - b), 0.F);
  return std::min(a, b) - h * h / (4.F * blend);
}

// Distances on a lattice; far from the surface only their signs are right.
class Lattice {
 public:
  Lattice(const Flesh& flesh, const Eigen::Vector3f& low, const Eigen::Vector3f& high, float cell_m)
      : low_(low), cell_(cell_m) {
    for (int i = 0; i < 3; ++i) {
      const int blocks = static_cast<int>((high[i] - low[i]) / (cell_m * kBlock)) + 1;
      size_[i] = blocks * kBlock;
    }
    values_.resize(std::size_t(size_.x()) * std::size_t(size_.y()) * std::size_t(size_.z()), kFar);
    for (int z = 0; z < size_.z(); z += kBlock) {
      for (int y = 0; y < size_.y(); y += kBlock) {
        for (int x = 0; x < size_.x(); x += kBlock) fill_block(flesh, {x, y, z});
      }
    }
  }

  [[nodiscard]] const Eigen::Vector3i& size() const { return size_; }
  [[nodiscard]] float cell() const { return cell_; }
  [[nodiscard]] Eigen::Vector3f place(const Eigen::Vector3i& at) const {
    return low_ + cell_ * at.cast<float>();
  }
  [[nodiscard]] std::size_t index(const Eigen::Vector3i& at) const {
    return (std::size_t(at.z()) * std::size_t(size_.y()) + std::size_t(at.y())) *
               std::size_t(size_.x()) +
           std::size_t(at.x());
  }
  [[nodiscard]] float operator()(const Eigen::Vector3i& at) const { return values_[index(at)]; }
  [[nodiscard]] std::size_t places() const { return values_.size(); }

 private:
  static constexpr int kBlock = 6;

  void fill_block(const Flesh& flesh, const Eigen::Vector3i& first) {
    const Eigen::Vector3f middle =
        place(first) + Eigen::Vector3f::Constant(cell_ * 0.5F * (kBlock - 1));
    const float at_middle = flesh.sample(middle).distance;
    const float half_diagonal = 0.866F * cell_ * kBlock;
    // Distances to stretched parts are approximate; hence twice the block's size.
    const bool empty = std::abs(at_middle) > 2.F * half_diagonal;
    const Flesh parts = empty ? Flesh(std::vector<FleshPart>{}) : flesh.near(middle, half_diagonal);
    for (int z = 0; z < kBlock; ++z) {
      for (int y = 0; y < kBlock; ++y) {
        for (int x = 0; x < kBlock; ++x) {
          const Eigen::Vector3i at = first + Eigen::Vector3i(x, y, z);
          values_[index(at)] = empty ? at_middle : parts.sample(place(at)).distance;
        }
      }
    }
  }

  Eigen::Vector3f low_;
  float cell_;
  Eigen::Vector3i size_;
  std::vector<float> values_;
};

Eigen::Vector3i corner_offset(int corner) {
  return {corner & 1, (corner >> 1) & 1, (corner >> 2) & 1};
}

// The mean of the points where the surface crosses a cell's edges; none where it does not.
std::optional<Eigen::Vector3f> mean_crossing(const Lattice& lattice, const Eigen::Vector3i& cell) {
  std::array<float, 8> values;
  bool all_in = true;
  bool all_out = true;
  for (int corner = 0; corner < 8; ++corner) {
    const float value = lattice(cell + corner_offset(corner));
    values[std::size_t(corner)] = value;
    (value < 0 ? all_out : all_in) = false;
  }
  if (all_in || all_out) return std::nullopt;
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  int crossings = 0;
  for (int a = 0; a < 8; ++a) {
    for (int axis = 0; axis < 3; ++axis) {
      const int b = a | (1 << axis);
      const float at_a = values[std::size_t(a)];
      const float at_b = values[std::size_t(b)];
      if (b == a || (at_a < 0) == (at_b < 0)) continue;
      const Eigen::Vector3f from = lattice.place(cell + corner_offset(a));
      const Eigen::Vector3f to = lattice.place(cell + corner_offset(b));
      sum += from + at_a / (at_a - at_b) * (to - from);
      ++crossings;
    }
  }
  return sum / static_cast<float>(crossings);
}

void add_quad(FleshSurface& surface, const std::array<std::uint32_t, 4>& quad) {
  const auto length2 = [&](std::size_t a, std::size_t b) {
    return (surface.positions[quad[a]] - surface.positions[quad[b]]).squaredNorm();
  };
  if (length2(0, 2) < length2(1, 3)) {
    surface.triangles.push_back({quad[0], quad[1], quad[2]});
    surface.triangles.push_back({quad[0], quad[2], quad[3]});
  } else {
    surface.triangles.push_back({quad[0], quad[1], quad[3]});
    surface.triangles.push_back({quad[1], quad[2], quad[3]});
  }
}

// Joins the corners of the four cells around each edge of the lattice that the surface crosses.
void add_triangles(FleshSurface& surface,
                   const Lattice& lattice,
                   const std::vector<std::uint32_t>& corner_of_cell) {
  const Eigen::Vector3i& size = lattice.size();
  for (int z = 1; z + 1 < size.z(); ++z) {
    for (int y = 1; y + 1 < size.y(); ++y) {
      for (int x = 1; x + 1 < size.x(); ++x) {
        const Eigen::Vector3i at(x, y, z);
        const bool inside = lattice(at) < 0;
        for (int axis = 0; axis < 3; ++axis) {
          if (inside == (lattice(at + Eigen::Vector3i::Unit(axis)) < 0)) continue;
          const Eigen::Vector3i u = Eigen::Vector3i::Unit((axis + 1) % 3);
          const Eigen::Vector3i v = Eigen::Vector3i::Unit((axis + 2) % 3);
          std::array<std::uint32_t, 4> quad = {corner_of_cell[lattice.index(at - u - v)],
                                               corner_of_cell[lattice.index(at - v)],
                                               corner_of_cell[lattice.index(at)],
                                               corner_of_cell[lattice.index(at - u)]};
          if (!inside) std::swap(quad[1], quad[3]);
          add_quad(surface, quad);
        }
      }
    }
  }
}

}  // namespace

Flesh::Flesh(const std::vector<FleshPart>& parts) {
  for (const FleshPart& part : parts) {
    const Eigen::Vector3f along = part.squeeze * (part.to - part.from);
    const float length2 = along.squaredNorm();
    parts_.push_back({part,
                      part.squeeze * part.from,
                      along,
                      length2 > 0 ? 1.F / length2 : 0.F,
                      (part.to - part.from).normalized()});
  }
}

// First-order distance: the value in the space where the part is round, over its slope.
float Flesh::Prepared::distance_to(const Eigen::Vector3f& p) const {
  const Eigen::Vector3f at = part.squeeze * p - squeezed_from;
  const float share = std::clamp(at.dot(squeezed_along) * inverse_length2, 0.F, 1.F);
  const Eigen::Vector3f out = at - share * squeezed_along;
  const float length = out.norm();
  const float radius = part.from_radius + share * (part.to_radius - part.from_radius);
  float d = length - radius;
  if (length > 1e-6F) d *= length / (part.squeeze.transpose() * out).norm();
  if (part.flat_end) d = std::max(d, (p - part.to).dot(end_direction));
  return d;
}

FleshSample Flesh::sample(const Eigen::Vector3f& p) const {
  std::array<float, kFleshLayers> melted;
  melted.fill(kFar);
  std::array<float, kFleshLayers> nearest = melted;
  std::array<std::uint8_t, kFleshLayers> charts{};
  for (const Prepared& prepared : parts_) {
    const FleshPart& part = prepared.part;
    const float d = prepared.distance_to(p);
    melted[part.layer] = melt(melted[part.layer], d, part.blend_m);
    if (d < nearest[part.layer]) {
      nearest[part.layer] = d;
      charts[part.layer] = part.chart;
    }
  }
  const std::size_t layer =
      std::size_t(std::min_element(melted.begin(), melted.end()) - melted.begin());
  return {melted[layer], static_cast<std::uint8_t>(layer), charts[layer]};
}

Flesh Flesh::near(const Eigen::Vector3f& p, float reach_m) const {
  std::vector<float> distances;
  float least = std::numeric_limits<float>::max();
  for (const Prepared& prepared : parts_) {
    distances.push_back(prepared.distance_to(p));
    least = std::min(least, distances.back());
  }
  Flesh kept;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    if (distances[i] < least + 3.F * reach_m + parts_[i].part.blend_m) {
      kept.parts_.push_back(parts_[i]);
    }
  }
  return kept;
}

Eigen::Vector3f Flesh::normal(const Eigen::Vector3f& p) const {
  constexpr float kStep = 0.003F;
  Eigen::Vector3f slope;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3f step = kStep * Eigen::Vector3f::Unit(i);
    slope[i] = sample(p + step).distance - sample(p - step).distance;
  }
  const float length = slope.norm();
  return length > 0 ? Eigen::Vector3f(slope / length) : Eigen::Vector3f::UnitZ();
}

FleshSurface surface_of(const Flesh& flesh,
                        const Eigen::Vector3f& low,
                        const Eigen::Vector3f& high,
                        float cell_m) {
  STILLMAP_CHECK(cell_m > 0 && (high - low).minCoeff() > 0);
  const Lattice lattice(flesh, low, high, cell_m);
  FleshSurface surface;
  std::vector<std::uint32_t> corner_of_cell(lattice.places(), 0);
  for (int z = 0; z + 1 < lattice.size().z(); ++z) {
    for (int y = 0; y + 1 < lattice.size().y(); ++y) {
      for (int x = 0; x + 1 < lattice.size().x(); ++x) {
        const Eigen::Vector3i cell(x, y, z);
        const std::optional<Eigen::Vector3f> crossing = mean_crossing(lattice, cell);
        if (!crossing) continue;
        Eigen::Vector3f p = *crossing;
        const Flesh parts = flesh.near(p, 0.01F);
        Eigen::Vector3f n = parts.normal(p);
        p -= std::clamp(parts.sample(p).distance, -0.5F * cell_m, 0.5F * cell_m) * n;
        n = parts.normal(p);
        corner_of_cell[lattice.index(cell)] = static_cast<std::uint32_t>(surface.positions.size());
        surface.positions.push_back(p);
        surface.normals.push_back(n);
      }
    }
  }
  add_triangles(surface, lattice, corner_of_cell);
  return surface;
}

}  // namespace stillmap
