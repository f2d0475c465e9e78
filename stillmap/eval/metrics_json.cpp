// SPDX-License-Identifier: Apache-2.0
#include "stillmap/eval/metrics_json.hpp"

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

Json frames_json(std::size_t total, std::size_t tracked) {
  const bool known = total > 0;
  const double ratio = known ? static_cast<double>(tracked) / static_cast<double>(total) : 0.0;
  return {{"total", total}, {"tracked", tracked}, {"ratio", known ? Json(ratio) : Json()}};
}

}  // namespace stillmap
