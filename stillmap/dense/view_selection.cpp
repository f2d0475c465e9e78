// SPDX-License-Identifier: Apache-2.0
#include "stillmap/dense/view_selection.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace stillmap {
namespace {

constexpr std::size_t kSamples = 512;      // of the view
constexpr std::size_t kHeldSamples = 128;  // of each view held
constexpr std::size_t kLossSamples = 64;   // of each view that may go
constexpr int kFew = 5;                    // views: what fewer see may be lost with one of them

/// A sample of a view's points, in the world frame.
std::vector<Eigen::Vector3f> samples(const PosedView& posed, std::size_t most) {
  const CompactCloud& points = posed.view->cloud;
  const std::size_t step = std::max<std::size_t>(1, points.size() / most);
  std::vector<Eigen::Vector3f> some;
  for (std::size_t i = step / 2; i < points.size(); i += step) {
    some.push_back((posed.T_world_camera * points.position(i).cast<double>()).cast<float>());
  }
  return some;
}

/// How the views held see a point of the new view.
struct Known {
  Sightings told;
  int from_near = 0;  // number of views that see it from near enough
};

/// How many of the new view's points another view sees.
struct Overlap {
  std::size_t seen = 0;
  std::size_t alike = 0;  // of these, those that it sees from about as far
};

void count(Known& known, const Sightings& one, bool is_near) {
  Sightings& told = known.told;
  if (one.through > 0 && told.through < 255) {
    ++told.through;
    ++told.through_last;
    told.seen_last = 0;
  } else if (one.seen > 0) {
    if (told.seen < 255) ++told.seen;
    if (told.seen_last < 255) ++told.seen_last;
    told.through_last = 0;
    known.from_near += is_near ? 1 : 0;
  }
}

class Comparison {
 public:
  Comparison(const CameraModel& camera,
             const ViewSelectionConfig& config,
             const FreeSpaceConfig& free_space)
      : camera_(camera), config_(config), free_space_(free_space), plain_(free_space) {
    plain_.weakly_seen = -1;  // motion beside points matters for the map, not here
  }

  /// `news.unknown` and `news.came`. Returns the views held that see half of the view from about as
  /// far, if many see half of it at all.
  [[nodiscard]] std::vector<PosedView> look_at(const PosedView& view,
                                               std::span<const PosedView> held,
                                               ViewGain& news) const {
    const std::vector<Eigen::Vector3f> points = samples(view, kSamples);
    if (points.empty()) return {};
    std::vector<Known> known(points.size());
    std::vector<PosedView> alike;
    int overlapping = 0;
    for (const PosedView& other : held) {
      const Overlap overlap = ask(other, view, points, known);
      overlapping += 2 * overlap.seen >= points.size() ? 1 : 0;
      if (2 * overlap.alike >= points.size()) alike.push_back(other);
    }
    if (overlapping < config_.most) alike.clear();
    int unknown = 0, came = 0;
    for (const Known& k : known) {
      unknown += k.from_near < config_.enough ? 1 : 0;
      came += stays(k.told, free_space_) ? 0 : 1;
    }
    news.unknown = unknown / static_cast<double>(points.size());
    news.came = came / static_cast<double>(points.size());
    return alike;
  }

  /// The one of some views held that shows the least which few others show, the new view included;
  /// the earliest of equals. Null for none.
  [[nodiscard]] const StaticView* least_needed(std::span<const PosedView> some,
                                               std::span<const PosedView> held,
                                               const PosedView& view) const {
    const StaticView* least = nullptr;
    double least_loss = 2;
    for (const PosedView& one : some) {
      const std::vector<Eigen::Vector3f> points = samples(one, kLossSamples);
      if (points.empty()) return one.view;
      std::vector<Known> known(points.size());
      (void)ask(view, one, points, known);
      for (const PosedView& other : held) {
        if (other.view != one.view) (void)ask(other, one, points, known);
      }
      const auto lost =
          std::ranges::count_if(known, [](const Known& k) { return k.from_near < kFew; });
      const double loss = static_cast<double>(lost) / static_cast<double>(points.size());
      if (loss >= least_loss) continue;
      least_loss = loss;
      least = one.view;
    }
    return least;
  }

  /// `news.went`.
  void look_through(const PosedView& view, std::span<const PosedView> held, ViewGain& news) const {
    std::vector<PosedRange> ranges;
    std::vector<Eigen::Vector3f> seen_through;
    std::size_t told_of = 0;
    for (const PosedView& other : held) {
      ranges.push_back({other.T_world_camera, &other.view->range});
      const std::vector<Eigen::Vector3f> points = samples(other, kHeldSamples);
      const std::vector<Sightings> told = tell(view, points);
      for (std::size_t i = 0; i < points.size(); ++i) {
        told_of += static_cast<std::size_t>(told[i].seen + told[i].through);
        if (told[i].through > 0) seen_through.push_back(points[i]);
      }
    }
    if (told_of == 0) return;
    const std::vector<Sightings> told = sightings(seen_through, ranges, camera_, free_space_);
    const auto went =
        std::ranges::count_if(told, [this](const Sightings& s) { return stays(s, free_space_); });
    news.went = static_cast<double>(went) / static_cast<double>(told_of);
  }

 private:
  [[nodiscard]] std::vector<Sightings> tell(const PosedView& view,
                                            std::span<const Eigen::Vector3f> points) const {
    const PosedRange range{view.T_world_camera, &view.view->range};
    return sightings(points, std::span(&range, 1), camera_, plain_);
  }

  /// Adds the sightings of another view's points by one view.
  Overlap ask(const PosedView& other,
              const PosedView& view,
              std::span<const Eigen::Vector3f> points,
              std::span<Known> known) const {
    const Eigen::Vector3f here = view.T_world_camera.translation().cast<float>();
    const Eigen::Vector3f there = other.T_world_camera.translation().cast<float>();
    const auto nearer = static_cast<float>(config_.nearer);
    const std::vector<Sightings> told = tell(other, points);
    Overlap overlap;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const float its_m = (points[i] - there).norm(), own_m = (points[i] - here).norm();
      const bool is_near = its_m <= nearer * own_m;
      count(known[i], told[i], is_near);
      if (told[i].seen == 0) continue;
      ++overlap.seen;
      overlap.alike += is_near && own_m <= nearer * its_m ? 1 : 0;
    }
    return overlap;
  }

  const CameraModel& camera_;
  const ViewSelectionConfig& config_;
  const FreeSpaceConfig& free_space_;
  FreeSpaceConfig plain_;
};

}  // namespace

ViewGain gain_of(const PosedView& view,
                 std::span<const PosedView> held,
                 const CameraModel& camera,
                 const ViewSelectionConfig& config,
                 const FreeSpaceConfig& free_space) {
  std::vector<PosedView> with_range;
  for (const PosedView& other : held) {
    if (!other.view->range.cells.empty()) with_range.push_back(other);
  }
  ViewGain news;
  const Comparison comparison(camera, config, free_space);
  const std::vector<PosedView> alike = comparison.look_at(view, with_range, news);
  const bool joins_anyway = is_worth_keeping(news, config);
  if (!joins_anyway && !view.view->range.cells.empty()) {
    comparison.look_through(view, with_range, news);
  }
  if (is_worth_keeping(news, config)) {
    news.replaces = comparison.least_needed(alike, with_range, view);
  }
  return news;
}

const StaticView* least_needed(std::span<const PosedView> held,
                               const PosedView& newest,
                               const CameraModel& camera,
                               const ViewSelectionConfig& config,
                               const FreeSpaceConfig& free_space) {
  return Comparison(camera, config, free_space).least_needed(held, held, newest);
}

bool is_worth_keeping(const ViewGain& news, const ViewSelectionConfig& config) {
  return news.unknown > config.min_unknown_share || news.came > config.min_changed_share ||
         news.went > config.min_changed_share;
}

}  // namespace stillmap
