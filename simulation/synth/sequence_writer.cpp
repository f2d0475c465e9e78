// SPDX-License-Identifier: Apache-2.0
#include "simulation/synth/sequence_writer.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include <fmt/core.h>

#include "simulation/synth/detection_faults.hpp"
#include "simulation/synth/stereo_folder.hpp"
#include "simulation/synth/truth_maps.hpp"
#include "stillmap/concurrency/parallel.hpp"
#include "stillmap/core/error.hpp"
#include "stillmap/io/folder_replacement.hpp"
#include "stillmap/io/image_io.hpp"
#include "stillmap/io/ply.hpp"
#include "stillmap/io/trajectory_io.hpp"
#include "stillmap/perception/detections/detections_io.hpp"
#include "stillmap/sensor/camera_io.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;

// A sequence is never mixed with existing files.
void check_vacant(const fs::path& folder) {
  std::error_code ignored;
  if (fs::exists(folder, ignored) && !fs::is_directory(folder, ignored)) {
    throw Error("{}: is a file, expected a folder for the sequence; name another", folder.string());
  }
  if (!is_vacant(folder)) {
    throw Error("{}: is not empty; name a new folder for the sequence or empty this one first",
                folder.string());
  }
}

bool is_file_of_sequence(const fs::path& name) {
  static constexpr std::array<std::string_view, 11> kNames = {"rgb",
                                                              "depth",
                                                              "truth",
                                                              "mav0",
                                                              "detections",
                                                              "assets.txt",
                                                              "camera.yaml",
                                                              "groundtruth.txt",
                                                              "associations.txt",
                                                              "depth.txt",
                                                              "rgb.txt"};
  return std::ranges::find(kNames, name.begin()->string()) != kNames.end();
}

struct Lists {
  std::string rgb = "# color images\n# timestamp filename\n";
  std::string depth = "# depth maps\n# timestamp filename\n";
  std::string associations;

  void add(const std::string& stamp, const std::string& depth_stamp) {
    rgb += fmt::format("{0} rgb/{0}.png\n", stamp);
    depth += fmt::format("{0} depth/{0}.png\n", depth_stamp);
    associations += fmt::format("{0} rgb/{0}.png {1} depth/{1}.png\n", stamp, depth_stamp);
  }
};

// A frame whose images are written, with its truth.
struct WrittenFrame {
  RenderedImage image;
  FrameTruth truth;
  TruthFrame objects;
};

// The share of each movable object that is within the image, in the order of speeds().
std::vector<double> visible_shares(const SyntheticSequence& sequence, FrameId id) {
  const Eigen::Isometry3d T_world_camera = sequence.pose(id);
  std::vector<double> shares;
  for (const MovableSurface& surface : movable_surfaces(sequence.world(), sequence.state(id))) {
    shares.push_back(share_in_view(surface.p_world, sequence.camera(), T_world_camera));
  }
  return shares;
}

// The movable objects, in the order of speeds().
std::vector<TruthObject> truth_objects(const SyntheticSequence& sequence,
                                       const std::vector<int>& moved) {
  std::vector<TruthObject> objects;
  const auto add = [&](int id, const std::string& class_name, const std::string& name) {
    objects.push_back({id, class_name, name, true, std::ranges::binary_search(moved, id)});
  };
  for (const Thing& thing : sequence.world().things) {
    if (thing.id != 0) add(thing.id, thing.class_name, thing.name);
  }
  for (const Person& person : sequence.world().people) add(person.id, "person", person.name);
  return objects;
}

// Renders a frame and writes its images.
WrittenFrame write_frame(const SyntheticSequence& sequence,
                         const std::vector<TruthObject>& objects,
                         const FolderReplacement& result,
                         const std::optional<StereoFolder>& stereo,
                         FrameId id) {
  const SyntheticFrame rendered = sequence.render(id);
  const RgbdFrame& frame = *rendered.frame;
  const std::string name = frame.stamp.text + ".png";
  result.write("rgb/" + name, encode_png(frame.color));
  result.write("depth/" + sequence.depth_stamp(id).text + ".png",
               encode_depth_png(frame.depth, sequence.camera().depth_factor));
  if (stereo) stereo->write_pair(frame);
  result.write("truth/masks/" + name, encode_mask_png(rendered.ids));

  const ObjectMask ids(rendered.ids);
  WrittenFrame written{rendered.truth,
                       {id, frame.stamp, ids, {}},
                       {frame.stamp, frame_objects(ids, sequence.speeds(id))}};
  const std::vector<double> shares = visible_shares(sequence, id);
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const TruthFrameObject& seen = written.objects.objects[i];
    written.truth.objects.push_back(
        {objects[i].id, objects[i].class_name, seen.box, seen.pixels, shares[i]});
  }
  return written;
}

// Collects the truth of the whole sequence.
class TruthFolder {
 public:
  TruthFolder(const SyntheticSequence& sequence, const std::vector<int>& moved)
      : maps_(sequence.camera(), moved) {}

  void add(const WrittenFrame& frame, const Eigen::Isometry3d& T_world_camera) {
    std::vector<int> moving;
    for (const TruthFrameObject& object : frame.objects.objects) {
      if (object.moving) moving.push_back(object.id);
    }
    maps_.add(
        frame.image.color, frame.image.depth, ObjectMask(frame.image.ids), T_world_camera, moving);
    frames_.push_back(frame.objects);
  }

  void write(const FolderReplacement& result,
             const CameraModel& camera,
             const std::vector<TruthObject>& objects) const {
    result.write("truth/static_map.ply", encode_ply(maps_.static_map()));
    result.write("truth/dynamic_map.ply", encode_ply(maps_.dynamic_map()));
    result.write("truth/resting_map.ply", encode_ply(maps_.resting_map()));
    result.write("truth/objects.json", format_objects_json(camera, objects, frames_));
  }

 private:
  TruthMaps maps_;
  std::vector<TruthFrame> frames_;
};

// The folder of detections, if requested.
class DetectionsMaker {
 public:
  DetectionsMaker(const SyntheticSequence& sequence,
                  const FolderReplacement& result,
                  DetectionKind kind)
      : kind_(kind), faults_(sequence.options().seed) {
    const CameraModel& camera = sequence.camera();
    if (kind == DetectionKind::kNone) return;
    writer_.emplace(result, "detections", cv::Size(camera.width_px, camera.height_px));
  }

  void add(const FrameTruth& truth) {
    if (!writer_) return;
    writer_->add(kind_ == DetectionKind::kPerfect ? perfect_detections(truth)
                                                  : faults_.apply(truth));
  }

  void finish() {
    if (writer_) writer_->finish();
  }

 private:
  DetectionKind kind_;
  DetectionFaults faults_;
  std::optional<DetectionsWriter> writer_;
};

}  // namespace

void write_sequence(const SyntheticSequence& sequence,
                    const fs::path& folder,
                    const WriteOptions& options,
                    const std::function<void(std::size_t, std::size_t)>& on_progress) {
  check_vacant(folder);
  FolderReplacement result(folder, is_file_of_sequence);
  const std::vector<int> moved = sequence.moved_ids();
  const std::vector<TruthObject> objects = truth_objects(sequence, moved);
  Lists lists;
  TruthFolder truth(sequence, moved);
  DetectionsMaker detections(sequence, result, options.detections);
  std::optional<StereoFolder> stereo;
  if (options.stereo_baseline_m > 0) stereo.emplace(sequence, result, options.stereo_baseline_m);
  produce_in_parallel(
      sequence.size(),
      options.threads,
      [&](std::size_t i) {
        return write_frame(
            sequence, objects, result, stereo, FrameId(static_cast<std::uint32_t>(i)));
      },
      [&](std::size_t i, const WrittenFrame& frame) {
        truth.add(frame, sequence.pose(frame.truth.frame));
        detections.add(frame.truth);
        lists.add(frame.truth.stamp.text, sequence.depth_stamp(frame.truth.frame).text);
        if (on_progress) on_progress(i + 1, sequence.size());
      });
  detections.finish();
  if (stereo) stereo->write_lists();
  truth.write(result, sequence.camera(), objects);
  if (sequence.options().assets) {
    result.write("assets.txt", sequence.options().assets->credits);
  }
  result.write("camera.yaml", format_camera_yaml(sequence.camera()));
  result.write("groundtruth.txt", format_trajectory(sequence.ground_truth()));
  result.write("associations.txt", lists.associations);
  result.write("depth.txt", lists.depth);
  result.write("rgb.txt", lists.rgb);
  result.take_place();
}

}  // namespace stillmap
