// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <map>
#include <vector>

#include <Eigen/Geometry>

#include "stillmap/dense/static_view.hpp"
#include "stillmap/geometry/camera.hpp"
#include "stillmap/perception/objects/object_identities.hpp"

namespace stillmap {

/// Knows where people stand whom the network no longer sees.
///
/// A person does not vanish. One who had walked, stood still for a second when last seen, and is
/// not seen any more stays there in 3-D until a view shows that the place is free: until it
/// measures surface behind most of it. People who never walked do not count, because they may be
/// things.
class StandingPeople {
 public:
  /// Remembers the movers of a frame, found in it or filled in. Stamps increase.
  void remember(double stamp_s, const std::vector<MoverSighting>& movers);

  /// Points on the people who stand unseen in the view of that time, in the odometry frame. Views
  /// come in the order of their stamps, after all frames until then.
  [[nodiscard]] std::vector<Eigen::Vector3d> unseen_in(const StaticView& view,
                                                       const CameraModel& camera,
                                                       const Eigen::Isometry3d& T_camera_odometry,
                                                       double stamp_s);

 private:
  struct Frame {
    double stamp_s;
    std::vector<MoverSighting> movers;
  };
  struct Person {
    std::vector<Eigen::Vector3d> surface;  // as last seen
    Eigen::Vector3d first = Eigen::Vector3d::Zero();
    Eigen::Vector3d place = Eigen::Vector3d::Zero();  // where the person is since `since_s`
    double since_s = 0, seen_s = 0;
    bool walked = false;
    bool left = false;
  };
  void see(double stamp_s, const MoverSighting& mover);

  std::deque<Frame> frames_;  // later than those taken into people_
  std::map<TrackId, Person> people_;
};

}  // namespace stillmap
