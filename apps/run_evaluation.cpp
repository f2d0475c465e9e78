// SPDX-License-Identifier: Apache-2.0
#include "apps/run_evaluation.hpp"

#include <utility>

#include <fmt/core.h>

#include "stillmap/core/error.hpp"
#include "tooling/eval/ate.hpp"
#include "tooling/eval/rpe.hpp"

namespace stillmap {

void evaluate(RunReport& report) {
  if (!report.groundtruth) return;
  report.ate = absolute_trajectory_error(*report.groundtruth, report.estimate);
  report.rpe = relative_pose_error(*report.groundtruth, report.estimate);
  if (!report.ate) {
    report.warnings.push_back("no ground-truth pose is within 0.02 s of three tracked frames");
  }
}

void choose_map(SequenceRun& run, bool at_true_poses) {
  if (at_true_poses) {
    if (run.map_at_true_poses) {
      run.result.map = std::move(*run.map_at_true_poses);
      run.report.map_at_true_poses = true;
    } else {
      run.report.warnings.push_back(
          "--poses truth: fewer than three tracked frames have ground truth; the map has the "
          "estimated poses");
    }
  }
  run.report.map = &run.result.map;
}

void evaluate_maps(SequenceRun& run, const SequenceTruth& truth) {
  RunReport& report = run.report;
  try {
    report.map_quality = run_map_quality(*report.map, report.estimate, truth);
    if (report.map_at_true_poses) {
      report.map_quality_true_poses = report.map_quality;
    } else if (run.map_at_true_poses) {
      report.map_quality_true_poses =
          run_map_quality(*run.map_at_true_poses, report.estimate, truth);
    }
  } catch (const Error& error) {  // a map that is nowhere must not cost the results of a long run
    report.warnings.push_back(fmt::format("no figures of the map: {}", error.what()));
  }
}

}  // namespace stillmap
