// SPDX-License-Identifier: Apache-2.0
#include "stillmap/dense/vacated_places.hpp"

#include <algorithm>
#include <functional>
#include <iterator>
#include <optional>

#include "stillmap/core/error.hpp"
#include "stillmap/dense/key_table.hpp"
#include "stillmap/dense/label_image.hpp"
#include "stillmap/dense/selected_points.hpp"
#include "stillmap/dense/voxel_key.hpp"
#include "stillmap/perception/detections/class_names.hpp"
#include "stillmap/perception/objects/similar_classes.hpp"

namespace stillmap {
namespace {

constexpr int kFewestSightings = 5;
constexpr std::size_t kSamplePoints = 64;
constexpr double kDecided = 0.3;    // share of the surface that a view must tell of
constexpr double kSeenAgain = 0.1;  // share of the surface that tells that it still stands there
constexpr int kFewestViews = 2;     // that see through a place, and that measure what came there
constexpr double kMostColorDistance = 0.6;
constexpr double kFromElsewhere = 0.25;
constexpr double kBesideExtent_m = 0.25;  // extents leave out thin ends: a foot, an arm
constexpr double kNearSurface_m = 0.02;

/// What the views tell of a thing's last place, by index of the view.
struct History {
  std::optional<std::size_t> came;  ///< the first view that measures it after some saw through
  std::vector<double> seen;         ///< share of its surface that each view measures
};

History history_of(const KnownObject& object,
                   std::span<const PosedView> views,
                   const CameraModel& camera,
                   const FreeSpaceConfig& config) {
  std::vector<Eigen::Vector3f> points;
  const std::size_t step = std::max<std::size_t>(1, object.surface.size() / kSamplePoints);
  for (std::size_t i = 0; i < object.surface.size(); i += step) {
    points.push_back(object.surface[i].cast<float>());
  }
  History history;
  int through = 0, after = 0;
  for (std::size_t v = 0; v < views.size(); ++v) {
    const PosedRange range{views[v].T_world_camera, &views[v].view->range};
    std::size_t seen = 0, free = 0;
    for (const Sightings& s : sightings(points, std::span(&range, 1), camera, config)) {
      seen += s.seen;
      free += s.through;
    }
    const auto all = static_cast<double>(points.size());
    history.seen.push_back(static_cast<double>(seen) / all);
    if (static_cast<double>(seen + free) < kDecided * all) continue;
    if (free > seen) {
      ++through;
      after = 0;
      history.came.reset();
    } else if (through >= kFewestViews) {
      ++after;
      if (!history.came) history.came = v;
    }
  }
  if (after < kFewestViews) history.came.reset();
  return history;
}

double likeness(const KnownObject& a, const KnownObject& b) {
  const double most = std::max(a.extent_area_m2, b.extent_area_m2);
  if (most <= 0 || !similar_classes(a.class_name, b.class_name)) return 0;
  const double colors = 1 - color_distance(a.colors, b.colors) / kMostColorDistance;
  return std::max(0.0, colors) * std::min(a.extent_area_m2, b.extent_area_m2) / most;
}

/// Whether views measured a thing at its place before one, and none since.
bool last_seen_before(const History& history, std::size_t view) {
  const auto at = history.seen.begin() + static_cast<std::ptrdiff_t>(view);
  const auto much = [](double share) { return share > kSeenAgain; };
  return std::any_of(history.seen.begin(), at, much) && std::none_of(at, history.seen.end(), much);
}

/// The places from which one thing may have come, each with its confidence.
std::vector<VacatedPlace> origins_of(std::size_t found,
                                     std::span<const KnownObject> objects,
                                     const std::vector<History>& histories) {
  std::vector<VacatedPlace> origins;
  double sum = kFromElsewhere;
  for (std::size_t k = 0; k < objects.size(); ++k) {
    if (k == found || histories[k].seen.empty()) continue;
    if (!last_seen_before(histories[k], *histories[found].came)) continue;
    const double fits = likeness(objects[k], objects[found]);
    sum += fits;
    origins.push_back({objects[k].track, objects[found].track, fits});
  }
  for (VacatedPlace& place : origins) place.confidence /= sum;
  return origins;
}

/// Cubes in which or beside which a surface is.
class NearSurface {
 public:
  void add(const Eigen::Vector3d& p) {
    const auto at = voxel_at(p / kNearSurface_m);
    if (!at) return;
    for (int k = 0; k < 27; ++k) {
      (void)cubes_.find_or_add(
          VoxelIndex{at->x + k / 9 - 1, at->y + k / 3 % 3 - 1, at->z + k % 3 - 1}.key());
    }
  }
  [[nodiscard]] bool covers(const Eigen::Vector3d& p) const {
    const auto at = voxel_at(p / kNearSurface_m);
    return at && cubes_.find(at->key()) != KeyTable::kNone;
  }

 private:
  KeyTable cubes_;
};

/// Whether a label is that of a class that networks take for an object's.
bool is_label_of(std::uint8_t label, const KnownObject& object) {
  const auto names = coco_class_names();
  return label > 0 && label <= names.size() &&
         similar_classes(names[label - 1U], coco_name(object.class_name));
}

/// Whether a point belongs to an object's place and not to that of another of a similar class.
bool is_at(const Eigen::Vector3d& p,
           const KnownObject& object,
           std::span<const KnownObject> objects) {
  const double outside_m = object.extent.exteriorDistance(p);
  return outside_m <= kBesideExtent_m &&
         std::ranges::none_of(objects, [&](const KnownObject& other) {
           return other.track != object.track && !other.extent.isEmpty() &&
                  similar_classes(other.class_name, object.class_name) &&
                  other.extent.exteriorDistance(p) < outside_m;
         });
}

/// Marks what has an object's label at its place, and the unlabelled rims of that.
void mark_gone(const PointCloud& map,
               std::span<const KnownObject> objects,
               TrackId track,
               std::vector<bool>& gone) {
  const auto found = std::ranges::find(objects, track, &KnownObject::track);
  STILLMAP_CHECK(found != objects.end());
  const KnownObject& object = *found;
  if (object.extent.isEmpty() || map.labels.empty()) return;
  std::vector<std::size_t> unlabelled;
  NearSurface near;
  for (std::size_t i = 0; i < map.size(); ++i) {
    const Eigen::Vector3d p = map.positions[i].cast<double>();
    if (!is_at(p, object, objects)) continue;
    if (is_label_of(map.labels[i], object)) {
      gone[i] = true;
      near.add(p);
    } else if (map.labels[i] == 0) {
      unlabelled.push_back(i);
    }
  }
  for (const std::size_t i : unlabelled) {
    if (near.covers(map.positions[i].cast<double>())) gone[i] = true;
  }
}

}  // namespace

std::vector<VacatedPlace> vacated_places(std::span<const KnownObject> objects,
                                         const CategoryTable& categories,
                                         std::span<const PosedView> views,
                                         const CameraModel& camera,
                                         const FreeSpaceConfig& config) {
  FreeSpaceConfig plain = config;
  plain.weakly_seen = -1;  // motion beside points does not matter here
  std::vector<History> histories(objects.size());
  for (std::size_t k = 0; k < objects.size(); ++k) {
    const KnownObject& object = objects[k];
    const bool counts = categories.of(object.class_name) == Category::kPotentiallyDynamic &&
                        object.sightings >= kFewestSightings && !object.surface.empty();
    if (counts) histories[k] = history_of(object, views, camera, plain);
  }
  std::vector<VacatedPlace> pairs, best;
  for (std::size_t k = 0; k < objects.size(); ++k) {
    if (!histories[k].came) continue;
    std::ranges::copy(origins_of(k, objects, histories), std::back_inserter(pairs));
  }
  std::ranges::stable_sort(pairs, std::ranges::greater{}, &VacatedPlace::confidence);
  for (const VacatedPlace& pair : pairs) {
    const bool used = std::ranges::any_of(best, [&](const VacatedPlace& other) {
      return other.left == pair.left || other.found == pair.found;
    });
    if (!used) best.push_back(pair);
  }
  return best;
}

PointCloud without_vacated(const PointCloud& map,
                           std::span<const KnownObject> objects,
                           std::span<const VacatedPlace> places) {
  std::vector<bool> gone(map.size(), false);
  for (const VacatedPlace& place : places) {
    if (place.counts()) mark_gone(map, objects, place.left, gone);
  }
  return selected_points(map, [&](std::size_t i) { return !gone[i]; });
}

MapWithoutVacated map_without_vacated(std::span<const PosedView> views,
                                      std::span<const KnownObject> objects,
                                      const CategoryTable& categories,
                                      const CameraModel& camera,
                                      const CloudConfig& config,
                                      std::size_t threads) {
  MapWithoutVacated map{static_map(views, camera, config, threads), {}};
  if (config.free_space != "on" || objects.empty()) return map;
  map.vacated = vacated_places(objects, categories, views, camera, config.free);
  map.points = without_vacated(map.points, objects, map.vacated);
  return map;
}

}  // namespace stillmap
