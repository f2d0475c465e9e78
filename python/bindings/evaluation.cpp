// SPDX-License-Identifier: Apache-2.0
#include <optional>
#include <string>

#include <nlohmann/json.hpp>
#include <pybind11/pybind11.h>
#include <pybind11/stl/filesystem.h>

#include "apps/commands/evaluate.hpp"
#include "python/bindings/arrays.hpp"
#include "python/bindings/bindings.hpp"
#include "python/bindings/values.hpp"
#include "stillmap/core/point_cloud.hpp"
#include "tooling/eval/ate.hpp"
#include "tooling/eval/map_files.hpp"
#include "tooling/eval/map_quality.hpp"
#include "tooling/eval/metrics_json.hpp"
#include "tooling/eval/rpe.hpp"

namespace stillmap::python {

namespace py = pybind11;

namespace {

constexpr const char* kEvaluateTrajectoryDoc =
    R"(The errors of a trajectory against ground truth, as in the TUM RGB-D benchmark.

Both are a Trajectory or a file. The dict is that of `stillmap evaluate trajectory --json`: "ate" in
metres after rigid alignment, "rpe" per second (None where the trajectory is too short).)";
constexpr const char* kEvaluateMapDoc =
    R"(A map against true surfaces: completeness, ghosts, accuracy.

`map`, `static` (the true static surface) and `dynamic` (what moving things swept) are a PointCloud
or a PLY file, and so is `resting`: moved things where they were last seen to stand, which count on
neither side. `groundtruth` and `trajectory`, both or none, align the map; without, map and truth
share a coordinate frame. The dict is that of "map" in `stillmap evaluate map --json`.)";

py::object as_python(const nlohmann::ordered_json& json) {
  return py::module_::import("json").attr("loads")(json.dump());
}

TrajectoryFile trajectory_of(const py::object& trajectory, const char* name) {
  if (py::isinstance<Poses>(trajectory)) {
    return {name, py::cast<const Poses&>(trajectory).trajectory};
  }
  return read_trajectory_file(py::cast<std::filesystem::path>(trajectory).string());
}

PointCloud cloud_of(const py::object& cloud, const char* name) {
  if (!py::isinstance<PointCloud>(cloud)) return read_map(py::cast<std::filesystem::path>(cloud));
  const auto& points = py::cast<const PointCloud&>(cloud);
  check_extent(points, name);
  return points;
}

py::object evaluate_trajectory(const py::object& groundtruth, const py::object& estimate) {
  const TrajectoryFile truth = trajectory_of(groundtruth, "groundtruth");
  const TrajectoryFile poses = trajectory_of(estimate, "estimate");
  nlohmann::ordered_json json;
  {
    const py::gil_scoped_release release;
    const std::optional<AteResult> ate = absolute_trajectory_error(truth.poses, poses.poses);
    if (!ate) throw too_few_pairs(truth, poses);
    json = {{"ate", ate_json(ate)},
            {"rpe", rpe_json(relative_pose_error(truth.poses, poses.poses))}};
  }
  return as_python(json);
}

py::object evaluate_map(const py::object& map,
                        const py::object& still,
                        const py::object& dynamic,
                        const py::object& groundtruth,
                        const py::object& trajectory,
                        const py::object& resting) {
  PointCloud points = cloud_of(map, "map");
  MapTruth truth{cloud_of(still, "static"), std::nullopt};
  if (truth.static_surface.empty()) throw Error("static: no points, expected the true surface");
  if (!dynamic.is_none()) truth.dynamic = cloud_of(dynamic, "dynamic");
  if (!resting.is_none()) truth.resting = cloud_of(resting, "resting");
  if (groundtruth.is_none() != trajectory.is_none()) {
    throw Error("groundtruth and trajectory align the map together: give both or none");
  }
  if (!groundtruth.is_none()) {
    points = moved(std::move(points),
                   required_alignment(trajectory_of(groundtruth, "groundtruth"),
                                      trajectory_of(trajectory, "trajectory")));
    check_extent(points, "map, moved to the ground truth");
  }
  nlohmann::ordered_json json;
  {
    const py::gil_scoped_release release;
    json = {{"points", points.size()}};
    json.update(map_quality_json(map_quality(points, truth)));
  }
  return as_python(json);
}

}  // namespace

void add_evaluation(py::module_& module) {
  module.def("evaluate_trajectory",
             &evaluate_trajectory,
             py::arg("groundtruth"),
             py::arg("estimate"),
             doc("evaluate_trajectory(groundtruth, estimate)", kEvaluateTrajectoryDoc).c_str());
  module.def("evaluate_map",
             &evaluate_map,
             py::arg("map"),
             py::arg("static"),
             py::arg("dynamic") = py::none(),
             py::arg("groundtruth") = py::none(),
             py::arg("trajectory") = py::none(),
             py::arg("resting") = py::none(),
             doc("evaluate_map(map, static, dynamic=None, groundtruth=None, trajectory=None, "
                 "resting=None)",
                 kEvaluateMapDoc)
                 .c_str());
}

}  // namespace stillmap::python
