// SPDX-License-Identifier: Apache-2.0
// How often LoopVerifier accepts pairs of views as one place: loop_table ROOM=FOLDER... Pairs of
// the same place by their angle, pairs of different places by their room; prints Markdown.
#include <algorithm>
#include <chrono>
#include <map>

#include <fmt/core.h>

#include "bench/place/views.hpp"
#include "stillmap/core/error.hpp"
#include "stillmap/slam/features/orb_extractor.hpp"
#include "stillmap/slam/loop/loop_verifier.hpp"

namespace stillmap {
namespace {

constexpr std::size_t kGap = 12;

struct Row {
  int pairs = 0;
  int accepted = 0;
  int most_inliers = 0;  // of all pairs, accepted or not
  double largest_share = 0;
  std::vector<double> shares, errors_m;  // of those accepted
};

LoopView view_of(const PlaceView& view, const MeasurementModel& measure) {
  Keyframe keyframe;
  keyframe.features = view.features;
  return loop_view(keyframe, Map(measure.level_scales()), view.camera, measure);
}

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return 0;
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
}

std::string row_name(const PlaceView& a, const PlaceView& b) {
  if (relation(a, b) == Relation::kDifferent) {
    return a.room == b.room ? a.room + ", elsewhere" : a.room + " and " + b.room;
  }
  const int bin = static_cast<int>(angle_deg(a, b) / 10) * 10;
  return fmt::format("{}, same, {} to {} degrees", a.room, bin, bin + 10);
}

void add_pair(Row& row, const PlaceView& a, const PlaceView& b, const MeasurementModel& measure) {
  const LoopVerifierConfig chosen, lenient{.min_inliers = 4, .min_share = 0, .max_sigma_m = 10};
  const std::optional<LoopMatch> loop = LoopVerifier(lenient, a.camera, measure, 0)
                                            .verify(FrameId(static_cast<std::uint32_t>(row.pairs)),
                                                    view_of(a, measure),
                                                    view_of(b, measure));
  ++row.pairs;
  if (!loop) return;
  const auto inliers = static_cast<int>(loop->matches.size());
  row.most_inliers = std::max(row.most_inliers, inliers);
  row.largest_share = std::max(row.largest_share, loop->share());
  if (inliers < chosen.min_inliers || loop->share() < chosen.min_share ||
      loop->edge.sigma_m > chosen.max_sigma_m) {
    return;
  }
  ++row.accepted;
  row.shares.push_back(loop->share());
  const Eigen::Isometry3d truth = a.T_world_camera.inverse() * b.T_world_camera;
  row.errors_m.push_back((loop->edge.T_a_b.translation() - truth.translation()).norm());
}

int run(const std::vector<std::string>& arguments) {
  std::vector<PlaceView> views;
  for (const std::string& argument : arguments) {
    for (PlaceView& view : read_views(argument, kGap)) views.push_back(std::move(view));
  }
  const MeasurementModel measure({.inverse_depth_sigma = 0.01}, pyramid_scales({}));
  std::map<std::string, Row> rows;
  std::size_t turn = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    for (std::size_t j = i + 1; j < views.size(); ++j) {
      const Relation how = relation(views[i], views[j]);
      if (how == Relation::kNeither || views[i].camera.width_px != views[j].camera.width_px)
        continue;
      if (++turn % 4 == 0)
        add_pair(rows[row_name(views[i], views[j])], views[i], views[j], measure);
    }
  }
  fmt::print(
      "| pairs of | number | accepted | most inliers | share: largest, 5 % | error m: median, 95 "
      "%, most |\n");
  fmt::print("|---|---|---|---|---|---|\n");
  for (const auto& [name, row] : rows) {
    fmt::print("| {} | {} | {} | {} | {:.2f} {:.2f} | {:.4f} {:.4f} {:.4f} |\n",
               name,
               row.pairs,
               row.accepted,
               row.most_inliers,
               row.largest_share,
               quantile(row.shares, 0.05),
               quantile(row.errors_m, 0.5),
               quantile(row.errors_m, 0.95),
               quantile(row.errors_m, 1));
  }
  return 0;
}

}  // namespace
}  // namespace stillmap

int main(int argc, char** argv) {
  try {
    return stillmap::run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    fmt::print(stderr, "loop_table: {}\n", error.what());
    return 2;
  }
}
