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
    visit("enabled",
          self.enabled,
          common_setting(FieldInfo{"whether loops are detected and closed"}));
    visit("candidates",
          self.candidates,
          FieldInfo{"number of key frames from the place index that are examined per key frame",
                    "",
                    1,
                    100});
    visit("inverse_depth_sigma",
          self.inverse_depth_sigma,
          FieldInfo{"measurement.inverse_depth_sigma for loop verification and global adjustment",
                    "1/m",
                    1e-4,
                    1});
    visit(
        "max_edge_chi2",
        self.max_edge_chi2,
        FieldInfo{
            "squared error, in sigmas, above which a loop contradicts the others and is not closed",
            "",
            1,
            1e9});
    LandmarkFusionConfig::fields(self.fusion, visit);
    visit("adjustment_lag_frames",
          self.adjustment_lag_frames,
          FieldInfo{"number of frames after which a global adjustment is applied, or later while "
                    "mapping is under way",
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
