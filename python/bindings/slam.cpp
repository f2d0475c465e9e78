// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/core.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "python/bindings/arrays.hpp"
#include "python/bindings/bindings.hpp"
#include "python/bindings/slam_session.hpp"
#include "python/bindings/values.hpp"

namespace stillmap::python {

namespace py = pybind11;

namespace {

constexpr const char* kSlamDoc =
    R"(Tracks a camera and maps its surroundings, one frame after another.

    slam = Slam("tum_fr1", settings={"tracking.features": 1500})
    frame = slam.process(color, depth, stamp)     # frame.pose
    result = slam.finish()                        # result.trajectory, result.map

`camera`: a Camera, or the name or file of one. `settings`: a dict by key; default_settings() lists
them, docs/settings.md explains them. Further keywords are settings, too, so that a dict may be given
as `**settings`. `threads`: the results are the same bits with any number.
`load`: a map.stillmap to go on from; with `localize_only` that map stays as it is. World coordinates
are those of the first tracked camera: x right, y down, z forward, metres. Python's lock is released
while the library works.)";
constexpr const char* kProcessDoc =
    R"(Tracks a frame and returns what became of it.

`color`: height x width x 3 uint8, red, green, blue. `depth`: height x width, float32 in metres (0,
NaN, infinite or negative: missing) or uint16 in units of the camera's depth_factor. `stamp`:
seconds, as a number or its text; later than the last. `objects`: the Detections of this image, by Segmenter
or any other network. None means that no network looked at it: in a run that had objects before,
they are carried on, and the frame adds nothing to the map.

Arrays are shared, not copied, and must not be changed afterwards. `copy=True` is for a camera that
writes its next images into the same arrays.)";
constexpr const char* kFrameDoc = R"(The result for one frame.

Positions and velocities are in the world of `pose`. Masks are height x width uint8, not 0 where a
pixel is in the mask, or None where the mode ignores motion.)";

std::string status_text(const ProcessedFrame& frame) {
  constexpr std::array<std::string_view, 4> kNames = {
      "initialized", "tracked", "relocalized", "lost"};
  return std::string(kNames.at(static_cast<std::size_t>(frame.result.status)));
}

py::object pose_of(const ProcessedFrame& frame) {
  if (!has_pose(frame.result)) return py::none();
  return matrix_array(frame.result.T_world_camera);
}

py::array feature_pixels(const ProcessedFrame& frame) {
  py::array_t<float> array(
      {static_cast<py::ssize_t>(frame.result.features.size()), py::ssize_t{2}});
  float* value = array.mutable_data();
  for (const FeatureMark& mark : frame.result.features) {
    *value++ = mark.raw_px.x();
    *value++ = mark.raw_px.y();
  }
  return array;
}

py::array feature_tracked(const ProcessedFrame& frame) {
  py::array_t<bool> array(static_cast<py::ssize_t>(frame.result.features.size()));
  bool* value = array.mutable_data();
  for (const FeatureMark& mark : frame.result.features) *value++ = mark.tracked;
  return array;
}

py::dict stage_times(const ProcessedFrame& frame) {
  py::dict times;
  for (const StageTime& time : frame.result.stages) times[py::str(time.stage)] = time.ms;
  return times;
}

template <class Image>
auto mask(Image FrameResult::*member) {
  return [member](const ProcessedFrame& frame) { return image_array((frame.result.*member).mat); };
}

template <class Value>
auto member(Value FrameResult::*value) {
  return [value](const ProcessedFrame& frame) { return frame.result.*value; };
}

void add_frame_result(py::module_& module) {
  py::class_<ProcessedFrame>(module, "FrameResult", kFrameDoc)
      .def_property_readonly(
          "id", [](const ProcessedFrame& self) { return self.result.id.value; }, "From 0.")
      .def_property_readonly(
          "stamp", [](const ProcessedFrame& self) { return self.result.stamp.seconds; }, "Seconds.")
      .def_property_readonly(
          "status", &status_text, "initialized (a map begins), tracked, relocalized or lost.")
      .def_property_readonly(
          "pose", &pose_of, "Camera to world, 4 x 4 float64; None where the camera is lost.")
      .def_property_readonly(
          "is_keyframe", member(&FrameResult::is_keyframe), "It has become a key frame.")
      .def_property_readonly("tracked_features",
                             member(&FrameResult::tracked_features),
                             "Number of features that fit the pose.")
      .def_property_readonly("features", &feature_pixels, "Pixels x, y, N x 2 float32.")
      .def_property_readonly("feature_tracked", &feature_tracked, "Which fit the pose, N bool.")
      .def_property_readonly(
          "objects", member(&FrameResult::objects), "The ObjectState of each object.")
      .def_property_readonly("object_mask",
                             mask(&FrameResult::object_mask),
                             "Pixels of all objects: i + 1 is objects[i].")
      .def_property_readonly("network_mask",
                             mask(&FrameResult::network_mask),
                             "Pixels of dynamic objects, by the network.")
      .def_property_readonly("extended_mask",
                             mask(&FrameResult::extended_mask),
                             "The same after the extension by depth.")
      .def_property_readonly("depth_jumps",
                             mask(&FrameResult::depth_jumps),
                             "Pixels whose depth has changed suddenly.")
      .def_property_readonly("excluded",
                             mask(&FrameResult::excluded),
                             "Pixels that no feature may have: masks, jumps and a margin.")
      .def_property_readonly("pose_ms",
                             member(&FrameResult::pose_ms),
                             "Milliseconds of all work that leads to the pose.")
      .def_property_readonly("stages", &stage_times, "Milliseconds of each stage by its name.")
      .def_readonly("library_ms",
                    &ProcessedFrame::library_ms,
                    "Milliseconds of the library's work; the rest of process() is Python's.")
      .def("__repr__", [](const ProcessedFrame& self) {
        return fmt::format(
            "<stillmap.FrameResult {} {}>", self.result.stamp.text, status_text(self));
      });
}

void add_run_result(py::module_& module) {
  using Result = RunResult;
  py::class_<Result, std::shared_ptr<Result>>(
      module, "RunResult", "The results of a finished run, under final poses.")
      .def_property_readonly(
          "trajectory",
          [](const Result& self) { return Poses{self.trajectory}; },
          "The poses of the tracked frames in the world of the map.")
      .def_property_readonly(
          "keyframes",
          [](const Result& self) { return Poses{self.keyframes}; },
          "The poses of the key frames, including those of a continued session.")
      .def_readonly("map", &Result::map, "The dense map: what stood still.")
      .def_property_readonly(
          "loops",
          [](const Result& self) {
            std::vector<std::pair<double, double>> loops;
            for (const ClosedLoop& loop : self.loops) {
              loops.emplace_back(loop.earlier.seconds, loop.later.seconds);
            }
            return loops;
          },
          "The stamps of both key frames of each closed loop.")
      .def_readonly("frames_elsewhere",
                    &Result::frames_elsewhere,
                    "Frames tracked in another map, which no known place joins to this one.")
      .def_readonly("lost_at_end", &Result::lost_at_end, "The last frame has no pose.")
      .def("__repr__", [](const Result& self) {
        return fmt::format(
            "<stillmap.RunResult: {} poses, {} points>", self.trajectory.size(), self.map.size());
      });
}

void add_slam_class(py::module_& module) {
  const std::string signature =
      "camera, settings=None, *, threads=2, load=None, localize_only=False, **more)";
  py::class_<Slam>(module, "Slam", doc("Slam(" + signature, kSlamDoc).c_str())
      .def(py::init([](const py::object& camera,
                       const py::object& settings,
                       int threads,
                       std::optional<std::filesystem::path> load,
                       bool localize_only,
                       const py::kwargs& more) {
             return std::make_unique<Slam>(camera_of(camera),
                                           settings_of(settings, more),
                                           SlamOptions{threads, std::move(load), localize_only});
           }),
           py::arg("camera"),
           py::arg("settings") = py::none(),
           py::kw_only(),
           py::arg("threads") = 2,
           py::arg("load") = py::none(),
           py::arg("localize_only") = false,
           doc("__init__(self, " + signature, "See the class.").c_str())
      .def(
          "process",
          [](Slam& self,
             const py::object& color,
             const py::object& depth,
             const py::object& stamp,
             const py::object& objects,
             bool copy) {
            return self.process({color, depth, stamp, objects, copy});
          },
          py::arg("color"),
          py::arg("depth"),
          py::arg("stamp"),
          py::arg("objects") = py::none(),
          py::kw_only(),
          py::arg("copy") = false,
          doc("process(self, color, depth, stamp, objects=None, *, copy=False)", kProcessDoc)
              .c_str())
      .def("map",
           &Slam::map,
           doc("map(self)", "The dense map so far, as finish() would give it now.").c_str())
      .def(
          "finish",
          [](Slam& self) { return std::const_pointer_cast<RunResult>(self.finish()); },
          doc("finish(self)", "Ends the run; later calls give the same RunResult.").c_str())
      .def("save",
           &Slam::save,
           py::arg("file"),
           doc("save(self, file)", "Saves the session as a map.stillmap, after finish().").c_str())
      .def_property_readonly("needs_objects",
                             &Slam::needs_objects,
                             "Whether a map can begin at the next frame only if its objects come "
                             "with it, in a run with a network.")
      .def_property_readonly(
          "camera", &Slam::camera, "The Camera, with the readout time as learnt so far.");
}

}  // namespace

void add_slam(py::module_& module) {
  add_frame_result(module);
  add_run_result(module);
  add_slam_class(module);
}

}  // namespace stillmap::python
