// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/motion/dynamics_stage.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "stillmap/geometry/se3.hpp"

namespace stillmap {
namespace {

std::vector<PixelBox> dynamic_boxes(const std::vector<ObjectState>& states) {
  std::vector<PixelBox> boxes;
  for (const ObjectState& state : states) {
    if (state.dynamic) boxes.push_back(state.box);
  }
  return boxes;
}

Mask widened(const Mask& mask, double margin_px) {
  const int side = 2 * static_cast<int>(std::lround(margin_px)) + 1;
  if (side <= 1) return mask;
  cv::Mat1b wide;
  cv::dilate(mask.mat, wide, cv::getStructuringElement(cv::MORPH_RECT, cv::Size(side, side)));
  return Mask(wide);
}

/// Marks the ids of the objects that belong to the given tracks.
std::array<bool, 256> objects_among(const FrameObjects& objects,
                                    const std::vector<TrackId>& tracks) {
  std::array<bool, 256> among{};
  for (std::size_t i = 0; i < objects.objects.size(); ++i) {
    among[i + 1] = std::ranges::find(tracks, objects.objects[i].track) != tracks.end();
  }
  return among;
}

/// Replaces the tracks of the objects of a frame in their states by lasting ones.
void identify_states(std::vector<ObjectState>& states,
                     const FrameObjects& objects,
                     const std::vector<TrackId>& lasting) {
  const auto identify = [&](TrackId& track) {
    const auto object = std::ranges::find(objects.objects, track, &TrackedObject::track);
    track = lasting[static_cast<std::size_t>(object - objects.objects.begin())];
  };
  for (ObjectState& state : states) {
    identify(state.track);
    if (state.person) identify(*state.person);
  }
}

/// The points of features with depth, in camera coordinates.
std::vector<Eigen::Vector3d> points_of(const Features& features, const CameraModel& camera) {
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < features.size(); ++i) {
    const auto depth = static_cast<double>(features.sensor_depth_m[i]);
    if (depth > 0) points.push_back(camera.unproject(features.ideal_px[i].cast<double>(), depth));
  }
  return points;
}

constexpr float kMostDoubt = 0.9F;  // at a score of 1
// Not 0: wrong poses and masks make still objects seem to move.
constexpr float kTrustOfMovers = 0.1F;

class JudgingStage final : public DynamicsStage {
 public:
  JudgingStage(const DynamicsConfig& config,
               const DynamicsMode& mode,
               const CameraModel& camera,
               std::uint32_t seed)
      : config_(config),
        masks_(mode.masks == MaskRule::kExact && config.search_masks ? MaskRule::kSearched
                                                                     : mode.masks),
        jumps_(mode.jumps),
        doubts_(mode.doubts),
        camera_(camera),
        objects_(config.objects, camera, mode),
        identities_(config.identity, objects_.categories(), camera),
        motions_(config.motion, camera),
        filter_(config.features, camera, mode, seed) {}

  [[nodiscard]] MeasuredObjects measure(const RgbdFrame& frame,
                                        const FrameObjects& objects) const override {
    return objects_.measure(frame.depth, objects);
  }
  [[nodiscard]] FrameDynamics judge(
      const RgbdFrame& frame,
      FrameObjects objects,
      const MeasuredObjects& measured,
      const std::optional<Eigen::Isometry3d>& T_odometry_camera_expected) override;
  [[nodiscard]] std::optional<DoubtedPixels> doubted(const FrameDynamics& dynamics) const override;
  [[nodiscard]] FilteredFeatures filter(
      const RgbdFrame& frame,
      Features features,
      const FrameDynamics& dynamics,
      const std::optional<Eigen::Isometry3d>& T_odometry_camera_expected) override;
  [[nodiscard]] std::vector<ObjectState> with_motion(const RgbdFrame& frame,
                                                     const Eigen::Isometry3d& T_odometry_camera,
                                                     const FrameDynamics& dynamics) override;
  void remember(const RgbdFrame& frame,
                const Eigen::Isometry3d& T_odometry_camera,
                const FrameDynamics& dynamics) override;
  void forget() override;
  [[nodiscard]] std::vector<UnitedTracks> united_tracks() const override {
    return identities_.united();
  }
  void know_objects(std::vector<KnownObject> objects) override {
    identities_.know(std::move(objects));
  }
  void place_known_objects(const Eigen::Isometry3d& T_odometry_world, double now_s) override {
    if (identities_.has_unplaced()) identities_.place(T_odometry_world, now_s);
  }
  [[nodiscard]] std::vector<KnownObject> known_objects(
      const Eigen::Isometry3d& T_odometry_world) const override {
    return identities_.all_in_world(T_odometry_world);
  }

 private:
  /// A remembered frame.
  struct PastView {
    DepthImage depth;
    Eigen::Isometry3d T_odometry_camera;
    Mask dynamic;
    std::int64_t number = 0;
    std::vector<Eigen::Vector3d> points = {};  // of its features, in its camera; by kMultiView
  };
  [[nodiscard]] std::vector<PreviousDepth> previous(
      const std::optional<Eigen::Isometry3d>& T_odometry_camera) const;
  [[nodiscard]] std::vector<PointView> nearest_views(
      const Eigen::Isometry3d& T_odometry_camera) const;
  [[nodiscard]] std::vector<float> trust_in(const FrameObjects& objects,
                                            const std::vector<ObjectState>& states) const;
  [[nodiscard]] const PastView* past_view(std::int64_t frames_ago) const;
  [[nodiscard]] const PastView* first_since_lost() const;

  DynamicsConfig config_;
  MaskRule masks_;
  JumpRule jumps_;
  bool doubts_;
  CameraModel camera_;
  DynamicObjects objects_;
  ObjectIdentities identities_;
  MotionEstimator motions_;
  FeatureFilter filter_;
  std::optional<PastView> last_;
  std::deque<PastView> past_;            // every few frames, the newest last
  std::int64_t number_ = 0;              // of frames remembered
  std::int64_t found_again_ = 0;         // number of the first frame since tracking was lost
  FeaturesPtr matchable_;                // features of the last frame
  std::vector<Eigen::Vector3d> points_;  // of the last frame, by kMultiView
};

// The newest view that is at least `frames_ago` frames old.
const JudgingStage::PastView* JudgingStage::past_view(std::int64_t frames_ago) const {
  for (auto view = past_.rbegin(); view != past_.rend(); ++view) {
    if (number_ - view->number >= frames_ago) return &*view;
  }
  return nullptr;
}

const JudgingStage::PastView* JudgingStage::first_since_lost() const {
  const auto view = std::ranges::find_if(
      past_, [&](const PastView& past) { return past.number >= found_again_; });
  return view != past_.end() ? &*view : nullptr;
}

std::vector<PreviousDepth> JudgingStage::previous(
    const std::optional<Eigen::Isometry3d>& T_odometry_camera) const {
  std::vector<PreviousDepth> frames;
  if (jumps_ == JumpRule::kPreviousFrame && last_) frames.push_back({last_->depth});
  if (jumps_ != JumpRule::kWarpedFrames || !T_odometry_camera || past_.empty()) return frames;
  const auto add = [&](const PastView* past) {
    if (past == nullptr) return;
    frames.push_back(
        {past->depth, T_odometry_camera->inverse() * past->T_odometry_camera, past->dynamic});
  };
  for (const int age : {1, 2, 4}) add(past_view(std::int64_t{age} * config_.compare_frames));
  if (number_ - found_again_ < config_.compare_frames) add(first_since_lost());
  return frames;
}

// Views near in place and direction have most in common; a radian counts as a metre.
std::vector<PointView> JudgingStage::nearest_views(
    const Eigen::Isometry3d& T_odometry_camera) const {
  std::vector<std::pair<double, PointView>> views;
  for (const PastView& past : past_) {
    const Eigen::Isometry3d T = T_odometry_camera.inverse() * past.T_odometry_camera;
    const double distance = T.translation().norm() + rotation_angle(T.linear());
    views.emplace_back(distance, PointView{past.points, T});
  }
  std::ranges::stable_sort(views, {}, &std::pair<double, PointView>::first);
  views.resize(std::min(views.size(), static_cast<std::size_t>(config_.multi_view.views)));
  std::vector<PointView> nearest;
  for (auto& [distance, view] : views) nearest.push_back(std::move(view));
  return nearest;
}

FrameDynamics JudgingStage::judge(
    const RgbdFrame& frame,
    FrameObjects objects,
    const MeasuredObjects& measured,
    const std::optional<Eigen::Isometry3d>& T_odometry_camera_expected) {
  FrameDynamics dynamics;
  const std::vector<TrackId> moving = motions_.moving(), standing = motions_.standing();
  dynamics.judged = objects_.judge(
      frame.depth, objects, measured, previous(T_odometry_camera_expected), {moving, standing});
  IdentifiedObjects identified = identities_.identify(
      frame, objects, measured.areas, measured.depths, T_odometry_camera_expected);
  identify_states(dynamics.judged.states, objects, identified.tracks);
  dynamics.movers = std::move(identified.movers);
  dynamics.objects = std::move(objects);
  if (jumps_ == JumpRule::kMultiView && T_odometry_camera_expected &&
      config_.objects.jump.enabled) {
    dynamics.judged.mask.jumps = hiding_objects(
        frame.depth, nearest_views(*T_odometry_camera_expected), camera_, config_.multi_view);
  }
  const DynamicMask& mask = dynamics.judged.mask;
  if (masks_ == MaskRule::kWidened) {
    dynamics.excluded = widened(mask.moving(), config_.feature_margin_px);
    dynamics.excluded_from_pose = dynamics.excluded;
  } else {
    dynamics.excluded = mask.all();
    dynamics.excluded_from_pose = Mask(mask.extended.mat);
  }
  if (masks_ != MaskRule::kSearched) dynamics.unsearched = dynamics.excluded_from_pose;
  return dynamics;
}

// The score of a network tells how surely it knows the class, not whether the object moves. Objects
// that have stood still since first seen are trusted more; people are not, because they sway.
std::vector<float> JudgingStage::trust_in(const FrameObjects& objects,
                                          const std::vector<ObjectState>& states) const {
  const std::array<bool, 256> moving = objects_among(objects, motions_.moving());
  const std::array<bool, 256> standing = objects_among(objects, motions_.standing());
  std::vector<float> trust;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const float score = std::clamp(objects.objects[i].detection.score, 0.0F, 1.0F);
    const float by_score = 1.0F - kMostDoubt * score;
    const float by_motion = moving[i + 1] ? kTrustOfMovers * by_score : by_score;
    trust.push_back(standing[i + 1] ? std::max(by_score, kTrustOfLandmarks) : by_motion);
  }
  return trust;
}

std::optional<DoubtedPixels> JudgingStage::doubted(const FrameDynamics& dynamics) const {
  const bool any_dynamic = std::ranges::any_of(dynamics.judged.states, &ObjectState::dynamic);
  if (!doubts_ || !any_dynamic) return std::nullopt;
  std::array<float, 256> trust{};
  trust[0] = 1.0F - kMostDoubt;  // the margin around an object
  std::ranges::copy(trust_in(dynamics.objects, dynamics.judged.states), trust.begin() + 1);
  const Mask jumps = widened(Mask(dynamics.judged.mask.jumps.mat), config_.feature_margin_px);
  DoubtedPixels pixels{Mask(cv::Mat1b(jumps.mat.size())), cv::Mat1f(jumps.mat.size())};
  for (int row = 0; row < jumps.mat.rows; ++row) {
    for (int x = 0; x < jumps.mat.cols; ++x) {
      const bool doubted = dynamics.excluded_from_pose.covers(row, x) && !jumps.covers(row, x);
      pixels.others.mat(row, x) = doubted ? 0 : 255;
      pixels.trust(row, x) = trust[dynamics.judged.mask.extended.mat(row, x)];
    }
  }
  return pixels;
}

FilteredFeatures JudgingStage::filter(
    const RgbdFrame& frame,
    Features features,
    const FrameDynamics& dynamics,
    const std::optional<Eigen::Isometry3d>& T_odometry_camera_expected) {
  FeatureScene scene{features,
                     frame.depth,
                     dynamic_boxes(dynamics.judged.states),
                     {},
                     std::exchange(matchable_, nullptr),
                     std::nullopt,
                     frame.id};
  if (masks_ == MaskRule::kSearched) scene.masks = dynamics.judged.mask.extended;
  if (T_odometry_camera_expected && last_) {
    scene.T_current_previous = T_odometry_camera_expected->inverse() * last_->T_odometry_camera;
  }
  FilteredFeatures filtered = filter_.filter(scene);
  matchable_ = filtered.matchable;
  if (jumps_ == JumpRule::kMultiView) points_ = points_of(filtered.features, camera_);
  return filtered;
}

std::vector<ObjectState> JudgingStage::with_motion(const RgbdFrame& frame,
                                                   const Eigen::Isometry3d& T_odometry_camera,
                                                   const FrameDynamics& dynamics) {
  std::vector<ObjectState> states = dynamics.judged.states;
  std::vector<Motion> motions =
      motions_.update(dynamics.objects, frame.depth, states, T_odometry_camera);
  for (std::size_t i = 0; i < states.size(); ++i) states[i].motion = std::move(motions[i]);
  return states;
}

void JudgingStage::remember(const RgbdFrame& frame,
                            const Eigen::Isometry3d& T_odometry_camera,
                            const FrameDynamics& dynamics) {
  last_ = {frame.depth, T_odometry_camera, {}, number_};
  // A third of the age's precision is enough, and a third of the memory.
  const int step = std::max(1, config_.compare_frames / 3);
  if ((number_ - found_again_) % step == 0) {
    past_.push_back({frame.depth,
                     T_odometry_camera,
                     dynamics.judged.mask.all(),
                     number_,
                     std::exchange(points_, {})});
  }
  ++number_;
  const std::int64_t oldest = number_ - std::int64_t{4} * config_.compare_frames - step;
  while (!past_.empty() && past_.front().number < oldest) past_.pop_front();
}

void JudgingStage::forget() {
  last_.reset();
  matchable_.reset();
  found_again_ = number_;
}

}  // namespace

ObjectTrackerConfig DynamicsConfig::object_tracking() const {
  ObjectTrackerConfig tracking = tracker;
  if (dynamics_mode(mode).fills_after_one_sighting) tracking.min_sightings = 1;
  if (!fill_boxes) tracking.search_frames = 0;
  return tracking;
}

MeasuredObjects DynamicsStage::measure(const RgbdFrame& /*frame*/,
                                       const FrameObjects& /*objects*/) const {
  return {};
}

FrameDynamics DynamicsStage::judge(
    const RgbdFrame& /*frame*/,
    FrameObjects /*objects*/,
    const MeasuredObjects& /*measured*/,
    const std::optional<Eigen::Isometry3d>& /*T_odometry_camera_expected*/) {
  return {};
}

std::optional<DoubtedPixels> DynamicsStage::doubted(const FrameDynamics& /*dynamics*/) const {
  return std::nullopt;
}

FilteredFeatures DynamicsStage::filter(
    const RgbdFrame& /*frame*/,
    Features features,
    const FrameDynamics& /*dynamics*/,
    const std::optional<Eigen::Isometry3d>& /*T_odometry_camera_expected*/) {
  FilteredFeatures all;
  all.features = std::move(features);
  return all;
}

std::vector<ObjectState> DynamicsStage::with_motion(const RgbdFrame& /*frame*/,
                                                    const Eigen::Isometry3d& /*T_odometry_camera*/,
                                                    const FrameDynamics& /*dynamics*/) {
  return {};
}

void DynamicsStage::remember(const RgbdFrame& /*frame*/,
                             const Eigen::Isometry3d& /*T_odometry_camera*/,
                             const FrameDynamics& /*dynamics*/) {}

void DynamicsStage::forget() {}

std::unique_ptr<DynamicsStage> make_dynamics_stage(const DynamicsConfig& config,
                                                   const CameraModel& camera,
                                                   std::uint32_t seed) {
  const DynamicsMode& mode = dynamics_mode(config.mode);
  if (!mode.judges) return std::make_unique<DynamicsStage>();
  return std::make_unique<JudgingStage>(config, mode, camera, seed);
}

}  // namespace stillmap
