// SPDX-License-Identifier: Apache-2.0
#include "stillmap/report/metrics_json.hpp"

#include "stillmap/eval/statistics.hpp"

namespace stillmap {
namespace {

using Json = nlohmann::ordered_json;

Json statistics_json(const std::optional<Statistics>& s) {
  if (!s) {
    return {{"rmse", nullptr},
            {"mean", nullptr},
            {"median", nullptr},
            {"std", nullptr},
            {"min", nullptr},
            {"max", nullptr}};
  }
  return {{"rmse", s->rmse},
          {"mean", s->mean},
          {"median", s->median},
          {"std", s->std},
          {"min", s->min},
          {"max", s->max}};
}

}  // namespace

Json ate_json(const std::optional<AteResult>& ate) {
  Json json = statistics_json(ate ? std::optional<Statistics>(ate->translation_m) : std::nullopt);
  json["pairs"] = ate ? Json(ate->pairs.size()) : Json();
  return json;
}

Json rpe_json(const std::optional<RpeResult>& rpe) {
  using Figures = std::optional<Statistics>;
  return {{"delta_s", rpe ? Json(rpe->delta_s) : Json()},
          {"pairs", rpe ? Json(rpe->pairs) : Json()},
          {"trans", statistics_json(rpe ? Figures(rpe->translation_m) : Figures())},
          {"rot_deg", statistics_json(rpe ? Figures(rpe->rotation_deg) : Figures())}};
}

}  // namespace stillmap
