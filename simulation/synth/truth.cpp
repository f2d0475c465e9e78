// SPDX-License-Identifier: Apache-2.0
#include "simulation/synth/truth.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include <nlohmann/json.hpp>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

struct Extent {
  int u0 = std::numeric_limits<int>::max();
  int v0 = std::numeric_limits<int>::max();
  int u1 = 0;
  int v1 = 0;
  int pixels = 0;
};

// All ids in one pass; most pixels have the id of the previous one, or none.
std::array<Extent, 256> extents(const cv::Mat1b& ids) {
  std::array<Extent, 256> found;
  for (int v = 0; v < ids.rows; ++v) {
    const std::uint8_t* row = ids[v];
    for (int u = 0; u < ids.cols;) {
      const std::uint8_t id = row[u];
      const int begin = u;
      while (u < ids.cols && row[u] == id) ++u;
      if (id == 0) continue;
      Extent& extent = found[id];
      extent.u0 = std::min(extent.u0, begin);
      extent.u1 = std::max(extent.u1, u);
      extent.v0 = std::min(extent.v0, v);
      extent.v1 = v + 1;
      extent.pixels += u - begin;
    }
  }
  return found;
}

std::string quoted(const std::string& text) {
  return nlohmann::json(text).dump();
}

std::string format_camera(const CameraModel& camera) {
  std::string text = fmt::format(R"({{"name":{},"width":{},"height":{})",
                                 quoted(camera.name),
                                 camera.width_px,
                                 camera.height_px);
  text += fmt::format(
      R"(,"fx":{},"fy":{},"cx":{},"cy":{})", camera.fx, camera.fy, camera.cx, camera.cy);
  if (camera.distorted()) {
    text += fmt::format(R"(,"k1":{},"k2":{},"p1":{},"p2":{},"k3":{})",
                        camera.k1,
                        camera.k2,
                        camera.p1,
                        camera.p2,
                        camera.k3);
    text += fmt::format(R"(,"k4":{},"k5":{},"k6":{})", camera.k4, camera.k5, camera.k6);
    if (camera.lens == LensModel::kFisheye) text += R"(,"lens":"fisheye")";
  }
  text += fmt::format(R"(,"depth_factor":{})", camera.depth_factor);
  if (camera.readout_s != 0) text += fmt::format(R"(,"readout_s":{})", camera.readout_s);
  return text + '}';
}

std::string format_object(const TruthObject& object) {
  return fmt::format(R"({{"id":{},"class":{},"name":{},"movable":{},"moved":{}}})",
                     object.id,
                     quoted(object.class_name),
                     quoted(object.name),
                     object.movable,
                     object.moved);
}

std::string format_frame_object(const TruthFrameObject& object) {
  const PixelBox& box = object.box;
  const std::string box_text =
      object.pixels > 0 ? fmt::format(R"("box":[{},{},{},{}],)", box.x0, box.y0, box.x1, box.y1)
                        : std::string();
  return fmt::format(R"({{"id":{},{}"pixels":{},"moving":{},"speed":{:.3f}}})",
                     object.id,
                     box_text,
                     object.pixels,
                     object.moving,
                     object.speed_mps);
}

std::string format_frame(const TruthFrame& frame) {
  std::string objects;
  for (const TruthFrameObject& object : frame.objects) {
    if (!objects.empty()) objects += ',';
    objects += format_frame_object(object);
  }
  return fmt::format(R"({{"stamp":{},"objects":[{}]}})", quoted(frame.stamp.text), objects);
}

// One element a line.
template <class Element>
std::string format_list(std::span<const Element> elements, std::string (*format)(const Element&)) {
  std::string text = "[";
  for (const Element& element : elements) {
    text += text.size() == 1 ? "\n" : ",\n";
    text += format(element);
  }
  return text + "]";
}

}  // namespace

std::vector<TruthFrameObject> frame_objects(const ObjectMask& ids,
                                            std::span<const ObjectSpeed> speeds) {
  std::array<Extent, 256> found = extents(ids.mat);
  std::vector<TruthFrameObject> objects;
  for (const ObjectSpeed& speed : speeds) {
    STILLMAP_CHECK(speed.id > 0 && speed.id < 256);
    Extent& extent = found[static_cast<std::size_t>(speed.id)];
    TruthFrameObject& object = objects.emplace_back();
    object.id = speed.id;
    object.pixels = extent.pixels;
    object.speed_mps = speed.speed_mps;
    object.moving = speed.speed_mps > kMovingSpeedMps;
    if (extent.pixels > 0) {
      object.box = {static_cast<double>(extent.u0),
                    static_cast<double>(extent.v0),
                    static_cast<double>(extent.u1),
                    static_cast<double>(extent.v1)};
    }
    extent.pixels = 0;  // already counted
  }
  for (const Extent& extent : found) STILLMAP_CHECK(extent.pixels == 0);
  return objects;
}

std::string format_objects_json(const CameraModel& camera,
                                std::span<const TruthObject> objects,
                                std::span<const TruthFrame> frames) {
  return fmt::format("{{\"camera\":{},\n\"objects\":{},\n\"frames\":{}}}\n",
                     format_camera(camera),
                     format_list(objects, format_object),
                     format_list(frames, format_frame));
}

double share_in_view(std::span<const Eigen::Vector3f> p_world,
                     const CameraModel& camera,
                     const Eigen::Isometry3d& T_world_camera) {
  const Eigen::Isometry3d T_camera_world = T_world_camera.inverse();
  std::size_t inside = 0;
  for (const Eigen::Vector3f& point : p_world) {
    const Eigen::Vector3d p_camera = T_camera_world * point.cast<double>();
    if (p_camera.z() <= 0) continue;
    // Borders by the ideal pixel: distortion moves them little, and far outside has no inverse.
    const Eigen::Vector2d px = camera.project(p_camera);
    const bool in_x = px.x() >= -0.5 && px.x() < camera.width_px - 0.5;
    const bool in_y = px.y() >= -0.5 && px.y() < camera.height_px - 0.5;
    inside += in_x && in_y ? 1 : 0;
  }
  return p_world.empty() ? 0.0 : static_cast<double>(inside) / static_cast<double>(p_world.size());
}

}  // namespace stillmap
