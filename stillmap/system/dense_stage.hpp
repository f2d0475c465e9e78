// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "stillmap/concurrency/job_ledger.hpp"
#include "stillmap/concurrency/stage_probe.hpp"
#include "stillmap/dense/missed_movers.hpp"
#include "stillmap/dense/standing_people.hpp"
#include "stillmap/dense/vacated_places.hpp"
#include "stillmap/perception/motion/dynamics_stage.hpp"
#include "stillmap/session/session.hpp"

namespace stillmap {

/// Makes the views of key frames and of some frames between them, and the dense map of these views.
class DenseStage {
 public:
  /// `config` is resolved. Views reach the session some frames after they were begun.
  DenseStage(const CloudConfig& config, const CameraModel& camera, const StageOptions& options);

  /// A stage with the same pending views, whose own work runs inline.
  [[nodiscard]] DenseStage inline_copy() const;

  /// A recorded frame whose masks are of that frame, not carried forward.
  struct Candidate {
    const FramePtr& frame;
    const FrameDynamics& dynamics;
    std::size_t record;  ///< its index in the session's frames
    bool is_keyframe;
  };
  /// Begins the candidate's view if one is due. To be called in the order of the records.
  void add(const Candidate& candidate, std::int64_t frame_number);

  /// Remembers the people in a frame, found in it or filled in.
  void remember_movers(double stamp_s, std::vector<MoverSighting> movers) {
    if (config_.missed_people != "on") return;
    standing_.remember(stamp_s, movers);
    missed_.remember(stamp_s, std::move(movers));
  }

  /// Adds the views that are due to the session, except those that show nothing new, and without
  /// surface where somebody must have been whom the network missed. The odometry frame is that of
  /// the movers.
  void collect_due(Session& session,
                   const Eigen::Isometry3d& T_odometry_world,
                   std::int64_t frame_number);

  /// The map of the posed views, without things at places that they have left for others. `objects`
  /// are in the world frame of the poses. The result is the same for any number of threads.
  [[nodiscard]] MapWithoutVacated map_of(std::span<const PosedView> views,
                                         std::span<const KnownObject> objects,
                                         const CategoryTable& categories,
                                         std::size_t threads) const {
    return map_without_vacated(views, objects, categories, camera_, config_, threads);
  }

  /// Whether views must know free space.
  [[nodiscard]] bool needs_free_space() const { return config_.free_space == "on"; }

 private:
  [[nodiscard]] bool is_due(std::int64_t record) const;
  void leave_out_missed(ViewRecord& made,
                        const Session& session,
                        const Eigen::Isometry3d& T_odometry_world);
  void keep_if_worth(Session& session, ViewRecord made) const;
  void keep_within_budget(Session& session) const;

  CloudConfig config_;
  CameraModel camera_;
  cv::Mat2f rays_;
  MissedMovers missed_;
  StandingPeople standing_;
  std::optional<std::int64_t> last_;  // record of the last view's frame
  JobLedger<ViewRecord> jobs_;
};

}  // namespace stillmap
