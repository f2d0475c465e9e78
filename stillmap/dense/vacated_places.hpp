// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "stillmap/core/point_cloud.hpp"
#include "stillmap/dense/free_space.hpp"
#include "stillmap/dense/static_map.hpp"
#include "stillmap/dense/static_view.hpp"
#include "stillmap/geometry/camera.hpp"
#include "stillmap/perception/objects/categories.hpp"
#include "stillmap/perception/objects/object_identities.hpp"
#include "stillmap/perception/objects/object_state.hpp"

namespace stillmap {

/// The places that nobody looked at again after a thing of the same look had come elsewhere.
///
/// A thing *came* if views first see through its surface and later ones measure it. It came from
/// somewhere: from the place of a thing of a similar class that no view has measured since, or from
/// where no view ever was. How well each of these fits, L, is 1 for equal colors and size and 0 for
/// colors 0.6 apart (Hellinger); unseen places have 0.25. The confidence that it came from a place
/// is that place's L over the sum of all. So of two equal chairs, one of which must have been
/// taken, both stay: the confidence is less than a half. Two equal chairs that both stand stay
/// because neither came. Pairs are made from the best down, and each object is used once on each
/// side.
///
/// `objects` are in the world frame of the poses. Only those that people move count
/// (Category::kPotentiallyDynamic), found in at least five frames. `views` are in the order of
/// their time.
[[nodiscard]] std::vector<VacatedPlace> vacated_places(std::span<const KnownObject> objects,
                                                       const CategoryTable& categories,
                                                       std::span<const PosedView> views,
                                                       const CameraModel& camera,
                                                       const FreeSpaceConfig& config);

/// The map without what stood at the places that count as vacated: points within 25 cm
/// of the object's extent, and of no similar object's nearer, that have a similar class as their
/// label, and unlabelled ones within 2 cm of these, by cubes of that edge: masks lack rims. A map
/// without labels stays as it is.
[[nodiscard]] PointCloud without_vacated(const PointCloud& map,
                                         std::span<const KnownObject> objects,
                                         std::span<const VacatedPlace> places);

/// A map, and the places that things have left for others, whatever the confidence.
struct MapWithoutVacated {
  PointCloud points;
  std::vector<VacatedPlace> vacated;
};

/// static_map() without_vacated(), where `config` removes what views see through; else
/// static_map(), and no places.
[[nodiscard]] MapWithoutVacated map_without_vacated(std::span<const PosedView> views,
                                                    std::span<const KnownObject> objects,
                                                    const CategoryTable& categories,
                                                    const CameraModel& camera,
                                                    const CloudConfig& config,
                                                    std::size_t threads = 1);

}  // namespace stillmap
