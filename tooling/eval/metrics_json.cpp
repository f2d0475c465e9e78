// SPDX-License-Identifier: Apache-2.0
#include "tooling/eval/metrics_json.hpp"

namespace stillmap {
namespace {

using Json = nlohmann::ordered_json;

Json rpe_statistics(const Statistics* s) {
  if (s == nullptr) {
    return {{"rmse", nullptr},
            {"mean", nullptr},
            {"median", nullptr},
            {"std", nullptr},
            {"max", nullptr}};
  }
  return {{"rmse", s->rmse},
          {"mean", s->mean},
          {"median", s->median},
          {"std", s->std},
          {"max", s->max}};
}

Json optional_json(const std::optional<double>& value) {
  return value ? Json(*value) : Json();
}

}  // namespace

Json ate_json(const std::optional<AteResult>& ate) {
  if (!ate) {
    return {{"rmse", nullptr},
            {"mean", nullptr},
            {"median", nullptr},
            {"std", nullptr},
            {"min", nullptr},
            {"max", nullptr},
            {"pairs", nullptr}};
  }
  const Statistics& s = ate->translation_m;
  return {{"rmse", s.rmse},
          {"mean", s.mean},
          {"median", s.median},
          {"std", s.std},
          {"min", s.min},
          {"max", s.max},
          {"pairs", ate->pairs.size()}};
}

Json rpe_json(const std::optional<RpeResult>& rpe) {
  return {{"delta_s", rpe ? Json(rpe->delta_s) : Json()},
          {"pairs", rpe ? Json(rpe->pairs) : Json()},
          {"trans", rpe_statistics(rpe ? &rpe->translation_m : nullptr)},
          {"rot_deg", rpe_statistics(rpe ? &rpe->rotation_deg : nullptr)}};
}

Json map_quality_json(const std::optional<MapQuality>& known) {
  const MapQuality quality = known.value_or(MapQuality());
  const std::optional<double> sa = known ? std::optional(quality.sa) : std::nullopt;
  const std::optional<GhostFigures>& ghosts = quality.ghosts;
  return {{"sa", optional_json(sa)},
          {"da", optional_json(quality.da)},
          {"aa", optional_json(quality.aa)},
          {"ha", optional_json(quality.ha)},
          {"accuracy_m", optional_json(quality.accuracy_m)},
          {"completeness_m", optional_json(quality.completeness_m)},
          {"completeness_ratio", optional_json(sa)},
          {"ghost_ratio", ghosts ? optional_json(ghosts->ratio) : Json()},
          {"ghost_volume_l", ghosts ? Json(ghosts->volume_l) : Json()},
          {"ghost_clusters", ghosts ? Json(ghosts->clusters) : Json()},
          {"off_ratio_5cm", optional_json(quality.off_ratio_5cm)},
          {"off_ratio_10cm", optional_json(quality.off_ratio_10cm)},
          {"voxels", known ? Json(quality.voxels) : Json()}};
}

Json residue_json(const Residue& residue) {
  return {{"ratio", residue.points > 0 ? Json(residue.ratio()) : Json()},
          {"points", residue.points},
          {"noise_floor", residue.points > 0 ? Json(residue.noise_floor()) : Json()},
          {"seen_through", residue.seen_through},
          {"by_noise", residue.by_noise},
          {"frames", residue.frames}};
}

Json frames_json(std::size_t total, std::size_t tracked) {
  const bool known = total > 0;
  const double ratio = known ? static_cast<double>(tracked) / static_cast<double>(total) : 0.0;
  return {{"total", total}, {"tracked", tracked}, {"ratio", known ? Json(ratio) : Json()}};
}

}  // namespace stillmap
