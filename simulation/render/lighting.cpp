// SPDX-License-Identifier: Apache-2.0
#include "simulation/render/lighting.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulation/scene/hash_random.hpp"
#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

// Samples of a neighbourhood of 4 x 4 use different rays, so that smoothing over it sees them all.
constexpr int kPattern = 4;
constexpr int kStep = 3;           // pixels from one sample to the next
constexpr float kNearness = 0.6F;  // metres within which near surfaces darken corners
constexpr float kOffSurface = 2e-3F;

// Entry i of n well spread points in the unit square (Hammersley's).
Eigen::Vector2f spread_point(int i, int n) {
  float radical = 0.F, half = 0.5F;
  for (int bits = i; bits > 0; bits >>= 1, half *= 0.5F) {
    if ((bits & 1) != 0) radical += half;
  }
  return {(static_cast<float>(i) + 0.5F) / static_cast<float>(n), radical};
}

// The number of a sample's ray among the pattern's rays: an order that looks random.
int pattern_index(int x, int y) {
  constexpr std::array<int, kPattern * kPattern> kOrder{
      0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5};
  return kOrder[static_cast<std::size_t>((y % kPattern) * kPattern + x % kPattern)];
}

Eigen::Vector3f lamp_point(const AreaLamp& lamp, const Eigen::Vector2f& at) {
  const Eigen::Vector2d uv = 2.0 * at.cast<double>() - Eigen::Vector2d::Ones();
  return (lamp.center_world + uv.x() * lamp.half_u_world + uv.y() * lamp.half_v_world)
      .cast<float>();
}

// A direction around `normal`, more often steep than flat.
Eigen::Vector3f direction_around(const Eigen::Vector3f& normal, const Eigen::Vector2f& at) {
  const float radius = std::sqrt(at.y());
  const float angle = 2.F * std::numbers::pi_v<float> * at.x();
  const Eigen::Vector3f side = normal.unitOrthogonal();
  return radius * std::cos(angle) * side + radius * std::sin(angle) * normal.cross(side) +
         std::sqrt(1.F - at.y()) * normal;
}

// Rays that are traced when a packet is full; unblocked rays set their target to 1.
class RayQueue {
 public:
  explicit RayQueue(const RayScene& scene) : scene_(&scene) {}

  void add(const Ray& ray, float& target) {
    rays_[count_] = ray;
    targets_[count_] = &target;
    if (++count_ == kRays) flush();
  }

  void flush() {
    if (count_ == 0) return;
    const std::uint32_t blocked = scene_->blocked({rays_.data(), count_});
    for (std::size_t i = 0; i < count_; ++i) {
      if ((blocked >> i & 1U) == 0) *targets_[i] = 1.F;
    }
    count_ = 0;
  }

 private:
  const RayScene* scene_;
  std::array<Ray, kRays> rays_;
  std::array<float*, kRays> targets_{};
  std::size_t count_ = 0;
};

bool smooth_between(const Surfel& a, const Surfel& b) {
  return a.hit.object == b.hit.object && a.normal.dot(b.normal) > 0.8F &&
         std::abs(a.normal.dot(b.point - a.point)) < 0.05F;
}

// The weighted mean of samples.
class OpennessMean {
 public:
  void add(const Openness& part, float weight) {
    add_share(sum_, part, weight);
    weights_ += weight;
  }

  [[nodiscard]] Openness value_or(const Openness& otherwise) const {
    if (weights_ <= 0) return otherwise;
    Openness mean{{}, 0.F};
    add_share(mean, sum_, 1.F / weights_);
    return mean;
  }

 private:
  static void add_share(Openness& sum, const Openness& part, float weight) {
    for (std::size_t i = 0; i < kMostLamps; ++i) sum.lamps[i] += weight * part.lamps[i];
    sum.around += weight * part.around;
  }

  Openness sum_{{}, 0.F};
  float weights_ = 0.F;
};

}  // namespace

Lighting::Lighting(const RayScene& scene,
                   const World& world,
                   const SurfaceBuffer& surfaces,
                   const LightOptions& options)
    : width_((surfaces.width + kStep - 1) / kStep), height_((surfaces.height + kStep - 1) / kStep) {
  STILLMAP_CHECK(world.lamps.size() <= kMostLamps);
  samples_.reserve(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  Openness start;
  if (!options.shadows) start.lamps.fill(1.F);
  if (options.shadows) start.around = 0.F;
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x)
      samples_.push_back({&surfaces.at(kStep * x, kStep * y), start});
  }
  if (!options.shadows) return;
  trace(scene, world);
  smooth(1, 0);
  smooth(0, 1);
}

void Lighting::trace(const RayScene& scene, const World& world) {
  constexpr int kSpots = kPattern * kPattern;
  const auto each_sample = [&](const auto& visit) {
    for (int y = 0; y < height_; ++y) {
      for (int x = 0; x < width_; ++x) {
        Sample& sample = samples_[static_cast<std::size_t>(y * width_ + x)];
        if (sample.surfel->hit.valid()) visit(sample, pattern_index(x, y));
      }
    }
  };
  RayQueue queue(scene);
  const auto origin_of = [](const Surfel& s) {
    return Eigen::Vector3f(s.point + kOffSurface * s.normal);
  };
  for (std::size_t lamp = 0; lamp < world.lamps.size(); ++lamp) {
    each_sample([&](Sample& sample, int spot) {
      const Eigen::Vector3f origin = origin_of(*sample.surfel);
      const Eigen::Vector3f direction =
          lamp_point(world.lamps[lamp], spread_point(spot, kSpots)) - origin;
      if (direction.dot(sample.surfel->normal) <= 0) return;
      // Ends before the panel of the lamp itself.
      queue.add({origin, direction, 0.98F}, sample.openness.lamps[lamp]);
    });
  }
  each_sample([&](Sample& sample, int spot) {
    const Eigen::Vector3f direction =
        direction_around(sample.surfel->normal, spread_point(spot, kSpots));
    queue.add({origin_of(*sample.surfel), direction, kNearness}, sample.openness.around);
  });
  queue.flush();
}

void Lighting::smooth(int dx, int dy) {
  // Four equal parts and two halves: each of the pattern's columns (or rows) counts the same.
  constexpr std::array<float, 5> kWeights{0.5F, 1.F, 1.F, 1.F, 0.5F};
  std::vector<Sample> smoothed = samples_;
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const Surfel& here = *sample_at(x, y).surfel;
      OpennessMean mean;
      for (int k = -2; k <= 2; ++k) {
        const int nx = x + k * dx, ny = y + k * dy;
        if (nx < 0 || ny < 0 || nx >= width_ || ny >= height_) continue;
        const Sample& near = sample_at(nx, ny);
        if (!smooth_between(here, *near.surfel)) continue;
        mean.add(near.openness, kWeights[static_cast<std::size_t>(k + 2)]);
      }
      Openness& target = smoothed[static_cast<std::size_t>(y * width_ + x)].openness;
      target = mean.value_or(target);
    }
  }
  samples_ = std::move(smoothed);
}

Openness Lighting::openness_at(int x, int y, const Surfel& surfel) const {
  OpennessMean mean;
  const int left = x / kStep, top = y / kStep;
  for (int ny = top; ny <= std::min(top + 1, height_ - 1); ++ny) {
    for (int nx = left; nx <= std::min(left + 1, width_ - 1); ++nx) {
      const Sample& near = sample_at(nx, ny);
      if (!smooth_between(surfel, *near.surfel)) continue;
      const int right = std::abs(x - kStep * nx), below = std::abs(y - kStep * ny);
      mean.add(near.openness, static_cast<float>((kStep - right) * (kStep - below)) + 1e-3F);
    }
  }
  return mean.value_or(sample_at(left, top).openness);
}

float light_on(const World& world,
               const Eigen::Vector3f& point,
               const Eigen::Vector3f& normal,
               const Openness& openness) {
  // Slightly more from above than from below: the ceiling is white.
  const float ambient = static_cast<float>(world.ambient) * (0.85F + 0.15F * normal.z());
  float light = ambient * openness.around;
  for (std::size_t i = 0; i < world.lamps.size(); ++i) {
    if (openness.lamps[i] <= 0) continue;
    const AreaLamp& lamp = world.lamps[i];
    const Eigen::Vector3f to_lamp = lamp.center_world.cast<float>() - point;
    const float squared = std::max(to_lamp.squaredNorm(), 0.25F);
    const float distance = std::sqrt(squared);
    const float on_surface = std::max(0.F, normal.dot(to_lamp)) / distance;
    const float off_lamp = std::max(0.F, to_lamp.z()) / distance;  // lamps face the floor
    light += openness.lamps[i] * static_cast<float>(lamp.power) * on_surface * off_lamp / squared;
  }
  return light;
}

}  // namespace stillmap
