// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tooling/pipeline/map_evaluation.hpp"
#include "tooling/pipeline/run_sequence.hpp"

namespace stillmap {

/// Adds the errors of the trajectory to the report, where it has true poses.
void evaluate(RunReport& report);

/// Makes the map of the report the estimated one or, where there is one, that at true poses.
void choose_map(SequenceRun& run, bool at_true_poses);

/// Adds the figures of the run's maps against the true surfaces to its report.
void evaluate_maps(SequenceRun& run, const SequenceTruth& truth);

}  // namespace stillmap
