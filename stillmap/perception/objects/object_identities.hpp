// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "stillmap/core/fields.hpp"
#include "stillmap/core/rgbd_frame.hpp"
#include "stillmap/geometry/camera.hpp"
#include "stillmap/perception/objects/categories.hpp"
#include "stillmap/perception/objects/frame_objects.hpp"
#include "stillmap/perception/objects/object_depth.hpp"
#include "stillmap/perception/objects/object_look.hpp"

namespace stillmap {

struct IdentityConfig {
  bool enabled = true;
  double reach_m = 0.35;
  double walking_m_s = 1.5;
  double most_color_distance = 0.6;
  double part_reach_m = 0.45;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("enabled",
          self.enabled,
          FieldInfo{"whether an object keeps its track while it is out of sight"});
    visit("reach_m",
          self.reach_m,
          FieldInfo{"distance from its last place at which an object is found again", "m", 0, 10});
    visit("walking_m_s",
          self.walking_m_s,
          FieldInfo{"speed at which that distance grows for objects that move by themselves",
                    "m/s",
                    0,
                    10});
    visit("most_color_distance",
          self.most_color_distance,
          FieldInfo{"greatest difference of colors (Hellinger distance) at which such an object is "
                    "found again after a second or more",
                    "",
                    0,
                    1});
    visit("part_reach_m",
          self.part_reach_m,
          FieldInfo{"distance at which a small detection is a part of a larger object of its class",
                    "m",
                    0,
                    10});
  }
};

/// An object as it is remembered. Positions are in the odometry frame.
struct KnownObject {
  TrackId track;                         ///< its identity
  std::string class_name;                ///< at its last detection
  double seen_s = 0;                     ///< stamp of its last detection
  int sightings = 0;                     ///< number of frames in which it was detected
  std::vector<Eigen::Vector3d> surface;  ///< a sample of the surface seen last
  Eigen::AlignedBox3d extent;            ///< of the largest part of it that was seen at once
  double extent_area_m2 = 0;             ///< silhouette of that part
  ColorShares colors{};                  ///< running mean
};

/// The object under another transform of its frame.
[[nodiscard]] KnownObject moved(KnownObject object, const Eigen::Isometry3d& T);

/// What a frame shows of an object that moves by itself.
struct MoverSighting {
  TrackId track;
  /// A sample, in the odometry frame; empty where the network missed it or is hardly sure, or
  /// without depth.
  std::vector<Eigen::Vector3d> surface;
};

/// The objects of a frame as they are known.
struct IdentifiedObjects {
  std::vector<TrackId> tracks;        ///< lasting, in the order of the frame's objects
  std::vector<MoverSighting> movers;  ///< those that move by themselves
};

/// Gives objects identities that last: an object that is seen again after it was hidden, missed for
/// long or outside the image has the track that it had before.
///
/// An ObjectTracker follows boxes from frame to frame; here its tracks are joined by place, size
/// and colors. A new track continues a known object of a similar class that is not in the frame if
/// it lies where that was last; for an object that moves by itself, within the distance that it can
/// have walked since, and then its colors must fit. A small detection beside or within a larger one
/// of its class is a part of it, such as a leg seen below a desk, and shares its track. Two tracks
/// may turn out to be of one object later: when a new one is recognised in its first frames, or two
/// things are in one place.
class ObjectIdentities {
 public:
  ObjectIdentities(const IdentityConfig& config,
                   const CategoryTable& categories,
                   const CameraModel& camera);

  /// Identifies the objects of a frame. `areas` and `depths` are of their masks; the pose is the
  /// predicted one, and without it no known object is found again.
  [[nodiscard]] IdentifiedObjects identify(
      const RgbdFrame& frame,
      const FrameObjects& objects,
      const MaskAreas& areas,
      std::span<const ObjectDepths> depths,
      const std::optional<Eigen::Isometry3d>& T_odometry_camera);

  /// Knows the objects of an earlier run, which it finds again once place() has told where they
  /// are.
  void know(std::vector<KnownObject> objects);
  /// Places the objects of know(): their frame in the odometry frame, at the time of the next
  /// frame.
  void place(const Eigen::Isometry3d& T_odometry_world, double now_s);
  /// Whether objects of know() have no place yet.
  [[nodiscard]] bool has_unplaced() const { return !unplaced_.empty(); }
  /// All objects, by track, in the world frame; those without a place as they were.
  [[nodiscard]] std::vector<KnownObject> all_in_world(
      const Eigen::Isometry3d& T_odometry_world) const;

  /// All objects that have a place, by track.
  [[nodiscard]] const std::vector<KnownObject>& known() const { return known_; }
  /// The tracks of earlier frames that turned out to be of one object, in the order of finding.
  [[nodiscard]] const std::vector<UnitedTracks>& united() const { return united_; }

 private:
  struct Sighting {
    TrackId tracklet;  // of the ObjectTracker
    std::string class_name;
    ObjectLook look;                                   // surface in the odometry frame
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();  // of the surface, where there is any
    bool detected = false;
    std::size_t known = kNone;  // index of the known object
  };
  struct Pair {
    double cost;
    std::size_t sighting, known;
  };
  struct Joined {
    TrackId tracklet, track;
    double seen_s = 0;
  };
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  [[nodiscard]] std::vector<Sighting> sightings_of(
      const RgbdFrame& frame,
      const FrameObjects& objects,
      const MaskAreas& areas,
      std::span<const ObjectDepths> depths,
      const std::optional<Eigen::Isometry3d>& T_odometry_camera) const;
  [[nodiscard]] std::optional<double> cost_of_return(const Sighting& sighting,
                                                     const KnownObject& object,
                                                     double now_s) const;
  [[nodiscard]] bool mobile(const KnownObject& object) const;
  [[nodiscard]] double gap(const Sighting& sighting, const KnownObject& object) const;
  [[nodiscard]] bool has_jumped(const Sighting& sighting,
                                const KnownObject& object,
                                double now_s) const;
  [[nodiscard]] std::size_t place_of(TrackId track) const;
  [[nodiscard]] std::vector<Pair> returns(const std::vector<Sighting>& sightings,
                                          double now_s) const;
  [[nodiscard]] std::size_t whole_of(const Sighting& part,
                                     const std::vector<Sighting>& sightings) const;
  void continue_tracks(std::vector<Sighting>& sightings, double now_s);
  void find_again(std::vector<Sighting>& sightings, double now_s);
  void begin_tracks(std::vector<Sighting>& sightings);
  void remember(const std::vector<Sighting>& sightings, double now_s);
  void unite_by_place(std::vector<Sighting>& sightings);
  void unite(TrackId later, TrackId earlier, std::vector<Sighting>& sightings);

  IdentityConfig config_;
  CategoryTable categories_;
  CameraModel camera_;
  std::vector<KnownObject> known_;     // by track
  std::vector<KnownObject> unplaced_;  // by track
  std::vector<Joined> joined_;         // tracks of the ObjectTracker that may go on
  std::vector<UnitedTracks> united_;
  std::uint32_t next_track_ = 0;
};

}  // namespace stillmap
