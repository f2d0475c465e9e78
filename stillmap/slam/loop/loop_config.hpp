// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stillmap/core/fields.hpp"
#include "stillmap/slam/loop/essential_graph.hpp"
#include "stillmap/slam/loop/loop_gate.hpp"
#include "stillmap/slam/loop/loop_verifier.hpp"
#include "stillmap/slam/mapping/landmark_fusion.hpp"
#include "stillmap/slam/optim/bundle_adjuster.hpp"
#include "stillmap/slam/optim/pose_graph.hpp"

namespace stillmap {

struct LoopConfig {
  bool enabled = true;
  int candidates = 3;
  double inverse_depth_sigma = 0.01;
  double max_edge_chi2 = 100;
  LandmarkFusionConfig fusion{.radius_px = 8};
  int adjustment_lag_frames = 60;
  LoopGateConfig gate;
  LoopVerifierConfig verifier;
  EssentialGraphConfig essential;
  PoseGraphConfig pose_graph;
  BundleConfig bundle;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("enabled", self.enabled, FieldInfo{"whether places seen before close loops"});
    visit("candidates",
          self.candidates,
          FieldInfo{"key frames that look most like the newest, which are asked", "", 1, 100});
    visit(
        "inverse_depth_sigma",
        self.inverse_depth_sigma,
        FieldInfo{
            "error of the inverse depth where loops are judged and the submap is adjusted to them",
            "1/m",
            1e-4,
            1});
    visit("max_edge_chi2",
          self.max_edge_chi2,
          FieldInfo{"a loop that all others contradict by more is not closed (squared error in "
                    "sigmas)",
                    "",
                    1,
                    1e9});
    LandmarkFusionConfig::fields(self.fusion, visit);
    visit("adjustment_lag_frames",
          self.adjustment_lag_frames,
          FieldInfo{"the adjustment of the whole map to a loop reaches it so many frames later, or "
                    "as soon then as no mapping is under way",
                    "frames",
                    0,
                    100000});
    visit.group("gate", self.gate);
    visit.group("verifier", self.verifier);
    visit.group("essential", self.essential);
    visit.group("pose_graph", self.pose_graph);
    visit.group("bundle", self.bundle);
  }
};

}  // namespace stillmap
