// SPDX-License-Identifier: Apache-2.0
#include "stillmap/dense/vacated_places.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "simulation/render/renderer.hpp"
#include "simulation/scene/office.hpp"
#include "simulation/synth/sequence.hpp"
#include "stillmap/dense/label_image.hpp"
#include "stillmap/dense/static_map.hpp"
#include "stillmap/perception/motion/dynamics_stage.hpp"

namespace stillmap {
namespace {

constexpr int kLook = 8;  // frames in one direction

/// A camera in the middle of the rendered office, 1.3 m high, that looks somewhat down at an angle
/// from the x axis.
Eigen::Isometry3d looking_at(double yaw, int frame) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  T_world_camera.translation() = Eigen::Vector3d(0.01 * frame, 0.005 * frame, 1.3);
  T_world_camera.rotate(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
                        Eigen::AngleAxisd(0.45, Eigen::Vector3d::UnitY()));
  return T_world_camera * T;
}

/// A place on the floor of the office, and the direction in which it is seen.
struct Place {
  double x, y;
  [[nodiscard]] double yaw() const { return std::atan2(y, x); }
  [[nodiscard]] double distance(const Eigen::Vector3f& p) const {
    return std::hypot(static_cast<double>(p.x()) - x, static_cast<double>(p.y()) - y);
  }
};
const Place kA{0.85, -1.95}, kB{-1.7, -0.6};

/// The rendered office with chairs at places, seen by a camera with true poses and a network
/// without fault.
class OfficeWithChairs {
 public:
  explicit OfficeWithChairs(std::vector<std::string> chairs) : chairs_(std::move(chairs)) {
    DynamicsConfig dynamics;
    dynamics.mode = "full";
    stage_ = make_dynamics_stage(dynamics, camera_, 0);
    config_ = CloudConfig().resolved_for(dynamics_mode("full").cloud);
  }

  /// The frames of a look towards a place while the chairs are where given; far away: out of the
  /// office.
  void look(const Place& towards, const std::vector<Place>& chairs) {
    World world = make_office(3);
    std::vector<int> ids;
    for (Thing& thing : world.things) {
      if (thing.class_name != "chair") continue;
      const auto named = std::ranges::find(chairs_, thing.name);
      const auto k = static_cast<std::size_t>(named - chairs_.begin());
      const Place at = named == chairs_.end() ? Place{50, 50} : chairs[k];
      thing.mesh = chair_mesh(world);
      thing.T_world_thing = Eigen::Isometry3d::Identity();
      thing.T_world_thing.translation() = Eigen::Vector3d(at.x, at.y, 0);
      thing.T_world_thing.rotate(Eigen::AngleAxisd(at.yaw(), Eigen::Vector3d::UnitZ()));
      if (named != chairs_.end()) ids.push_back(thing.id);
    }
    WorldState state;
    for (const Thing& thing : world.things) state.T_world_things.push_back(thing.T_world_thing);
    const Renderer renderer(std::make_shared<const World>(world), camera_, {{}, false});
    for (int k = 0; k < kLook; ++k) see(renderer, state, looking_at(towards.yaw(), k), ids);
  }

  [[nodiscard]] std::vector<VacatedPlace> vacated() const {
    return vacated_places(objects(), CategoryTable({}), posed(), camera_, config_.free);
  }
  /// How many points above the floor the map has within half a metre of a place.
  [[nodiscard]] std::size_t points_above_floor(const Place& at, bool with_objects = true) const {
    const std::vector<KnownObject> known = with_objects ? objects() : std::vector<KnownObject>();
    const PointCloud map =
        map_without_vacated(posed(), known, CategoryTable({}), camera_, config_).points;
    std::size_t count = 0;
    for (std::size_t i = 0; i < map.size(); ++i) {
      const Eigen::Vector3f& p = map.positions[i];
      count += p.z() > 0.05F && at.distance(p) < 0.5 ? 1 : 0;
    }
    return count;
  }

 private:
  /// All chairs look alike: that of the first.
  [[nodiscard]] static Mesh chair_mesh(const World& world) {
    return std::ranges::find(world.things, std::string("chair_3"), &Thing::name)->mesh;
  }
  [[nodiscard]] std::vector<KnownObject> objects() const {
    return stage_->known_objects(Eigen::Isometry3d::Identity());
  }
  [[nodiscard]] std::vector<PosedView> posed() const {
    std::vector<PosedView> posed;
    for (std::size_t k = 0; k < views_.size(); ++k) posed.push_back({poses_[k], views_[k].get()});
    return posed;
  }

  void see(const Renderer& renderer,
           const WorldState& state,
           const Eigen::Isometry3d& T_world_camera,
           const std::vector<int>& ids) {
    const RenderedImage image = renderer.render(Exposure::still(T_world_camera, state));
    RgbdFrame frame;
    frame.stamp.seconds = static_cast<double>(views_.size()) / 10;
    frame.color = image.color;
    frame.depth = image.depth;
    FrameObjects found;
    found.stamp = frame.stamp;
    cv::Mat1b mask(image.ids.size(), std::uint8_t{0});
    for (const int id : ids) {
      const cv::Mat1b own = image.ids == id;
      const cv::Rect area = cv::boundingRect(own);
      if (area.area() < 400) continue;
      TrackedObject object;
      object.detection.id = static_cast<int>(found.objects.size()) + 1;
      object.detection.class_name = "chair";
      object.detection.score = 0.9F;
      object.detection.box = {static_cast<double>(area.x),
                              static_cast<double>(area.y),
                              static_cast<double>(area.br().x),
                              static_cast<double>(area.br().y)};
      // A tracker of boxes loses what is out of sight.
      object.track = TrackId(static_cast<std::uint32_t>(id) * 1000 +
                             static_cast<std::uint32_t>(views_.size()) / kLook);
      mask.setTo(object.detection.id, own);
      found.objects.push_back(object);
    }
    found.mask = ObjectMask(mask);
    const FrameDynamics judged =
        stage_->judge(frame, found, stage_->measure(frame, found), T_world_camera);
    const LabelImage labels = label_image(frame.depth, judged);
    views_.push_back(std::make_shared<const StaticView>(
        static_view(frame,
                    pixel_rays(camera_),
                    config_,
                    dynamic_regions(judged.judged.mask, judged.excluded),
                    labels)));
    poses_.push_back(T_world_camera);
    stage_->remember(frame, T_world_camera, judged);
  }

  CameraModel camera_ = synthetic_camera(320, 240);
  CloudConfig config_;
  std::vector<std::string> chairs_;
  std::unique_ptr<DynamicsStage> stage_;
  std::vector<std::shared_ptr<const StaticView>> views_;
  std::vector<Eigen::Isometry3d> poses_;
};

TEST(VacatedPlaces, AChairThatWasMovedOutOfViewIsThereOnce) {
  OfficeWithChairs office({"chair_3"});
  office.look(kA, {kA});
  office.look(kB, {kA});  // nothing there yet
  office.look(kB, {kB});
  const std::vector<VacatedPlace> places = office.vacated();
  ASSERT_EQ(places.size(), 1U);
  EXPECT_TRUE(places[0].counts());
  EXPECT_LE(places[0].confidence, 0.8 + 1e-9);  // it may still be another
  // Without it the chair stands at both places; with it at one.
  OfficeWithChairs never_there({"chair_3"});
  never_there.look(kA, {{50, 50}});
  const std::size_t room = never_there.points_above_floor(kA);
  const std::size_t twice = office.points_above_floor(kA, false);
  EXPECT_GT(twice, room + 500);
  EXPECT_LT(office.points_above_floor(kA), room + (twice - room) / 20);
  EXPECT_EQ(office.points_above_floor(kB), office.points_above_floor(kB, false));
  EXPECT_GT(office.points_above_floor(kB), 500U);
}

TEST(VacatedPlaces, TwoEqualChairsThatStandStayBoth) {
  OfficeWithChairs office({"chair_2", "chair_3"});
  office.look(kA, {kA, kB});
  office.look(kB, {kA, kB});
  EXPECT_TRUE(office.vacated().empty());
  EXPECT_EQ(office.points_above_floor(kA), office.points_above_floor(kA, false));
  EXPECT_GT(office.points_above_floor(kA), 500U);
  EXPECT_GT(office.points_above_floor(kB), 500U);
}

TEST(VacatedPlaces, AChairSeenAgainWhereItWasStays) {
  OfficeWithChairs office({"chair_2", "chair_3"});
  office.look(kA, {{50, 50}, kA});
  office.look(kB, {{50, 50}, kA});
  office.look(kB, {kB, kA});  // another chair, from outside
  office.look(kA, {kB, kA});
  EXPECT_TRUE(office.vacated().empty());
  EXPECT_EQ(office.points_above_floor(kA), office.points_above_floor(kA, false));
}

TEST(VacatedPlaces, WhichOfTwoEqualChairsCameIsNotKnown) {
  const Place other{1.15, 0.95};
  OfficeWithChairs office({"chair_2", "chair_3"});
  office.look(kA, {other, kA});
  office.look(other, {other, kA});
  office.look(kB, {other, kA});
  office.look(kB, {other, kB});
  const std::vector<VacatedPlace> places = office.vacated();
  ASSERT_EQ(places.size(), 1U);
  EXPECT_LT(places[0].confidence, 0.5);
  EXPECT_EQ(office.points_above_floor(kA), office.points_above_floor(kA, false));
  EXPECT_EQ(office.points_above_floor(other), office.points_above_floor(other, false));
}

}  // namespace
}  // namespace stillmap
