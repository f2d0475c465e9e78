// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <type_traits>

#include "stillmap/session/codec.hpp"
#include "stillmap/session/sections.hpp"

namespace stillmap {
namespace {

constexpr std::array kCameraNumbers = {&CameraModel::fx,
                                       &CameraModel::fy,
                                       &CameraModel::cx,
                                       &CameraModel::cy,
                                       &CameraModel::k1,
                                       &CameraModel::k2,
                                       &CameraModel::p1,
                                       &CameraModel::p2,
                                       &CameraModel::k3,
                                       &CameraModel::depth_factor,
                                       &CameraModel::readout_s};

// Only from kWideLensVersion on; before them stands the lens (u32).
constexpr std::array kWideLensNumbers = {&CameraModel::k4, &CameraModel::k5, &CameraModel::k6};

bool has_wide_lens(const CameraModel& camera) {
  return camera.lens != LensModel::kBrownConrady || camera.k4 != 0 || camera.k5 != 0 ||
         camera.k6 != 0;
}

// A cell is 16 bits: the range in units of 2 mm; the highest bit marks motion.
static_assert(sizeof(RangeCell) == sizeof(std::uint16_t) &&
              std::is_trivially_copyable_v<RangeCell>);

void put(ByteWriter& out, const Eigen::Vector3f& v) {
  for (int i = 0; i < 3; ++i) out.number(v[i]);
}

Eigen::Vector3f take_vector(ByteReader& in) {
  Eigen::Vector3f v;
  for (int i = 0; i < 3; ++i) v[i] = in.number<float>();
  return v;
}

void put(ByteWriter& out, const CompactCloud& cloud) {
  out.count(cloud.size());
  out.flag(!cloud.labels.empty());
  put(out, cloud.origin);
  put(out, cloud.step);
  out.array<std::uint16_t>(cloud.places);
  out.array<std::uint8_t>(cloud.colors);
  out.array<std::uint8_t>(cloud.labels);
}

CompactCloud take_cloud(ByteReader& in) {
  const auto size = static_cast<std::size_t>(in.number<std::uint32_t>());
  const bool with_labels = in.flag();
  if (size == 0 && with_labels) throw Error("{}: invalid flag", in.place());
  CompactCloud cloud;
  cloud.origin = take_vector(in);
  cloud.step = take_vector(in);
  cloud.places = in.array<std::uint16_t, std::array<std::uint16_t, 3>>(size);
  cloud.colors = in.array<std::uint8_t, Rgb>(size);
  cloud.labels = in.array<std::uint8_t, std::uint8_t>(with_labels ? size : 0);
  return cloud;
}

void put(ByteWriter& out, const RangeImage& range) {
  out.number(static_cast<std::int32_t>(range.block_px));
  out.number(static_cast<std::int32_t>(range.columns));
  out.number(static_cast<std::int32_t>(range.rows));
  out.array<std::uint16_t>(range.cells);
}

RangeImage take_range(ByteReader& in) {
  RangeImage range;
  range.block_px = in.number<std::int32_t>();
  range.columns = in.number<std::int32_t>();
  range.rows = in.number<std::int32_t>();
  if (range.columns < 0 || range.rows < 0) throw Error("{}: invalid image size", in.place());
  // Both are below 2^31, so that their product fits.
  range.cells = in.array<std::uint16_t, RangeCell>(static_cast<std::size_t>(range.columns) *
                                                   static_cast<std::size_t>(range.rows));
  return range;
}

}  // namespace

ByteWriter encode(const CameraModel& camera) {
  ByteWriter out;
  out.text(camera.name);
  out.number(static_cast<std::int32_t>(camera.width_px));
  out.number(static_cast<std::int32_t>(camera.height_px));
  for (double CameraModel::*number : kCameraNumbers) out.number(camera.*number);
  if (has_wide_lens(camera)) {
    out.number(static_cast<std::uint32_t>(camera.lens));
    for (double CameraModel::*number : kWideLensNumbers) out.number(camera.*number);
  }
  return out;
}

CameraModel decode_camera(ByteReader content) {
  CameraModel camera;
  camera.name = content.text();
  camera.width_px = content.number<std::int32_t>();
  camera.height_px = content.number<std::int32_t>();
  for (double CameraModel::*number : kCameraNumbers) camera.*number = content.number<double>();
  if (!content.at_end()) {
    const auto lens = content.number<std::uint32_t>();
    if (lens > static_cast<std::uint32_t>(LensModel::kFisheye)) {
      throw Error("{}: invalid lens {}", content.place(), lens);
    }
    camera.lens = static_cast<LensModel>(lens);
    for (double CameraModel::*number : kWideLensNumbers) camera.*number = content.number<double>();
  }
  content.finish();
  return camera;
}

std::uint32_t version_for(const CameraModel& camera, std::span<const ViewRecord> views) {
  const auto is_untimed = [](const ViewRecord& view) { return view.depth_after_color_s == 0; };
  if (!std::ranges::all_of(views, is_untimed)) return kSessionVersion;
  return has_wide_lens(camera) ? kWideLensVersion : kOldestSessionVersion;
}

ByteWriter encode_text(const std::string& text) {
  ByteWriter out;
  out.text(text);
  return out;
}

std::string decode_text(ByteReader content) {
  std::string text = content.text();
  content.finish();
  return text;
}

ByteWriter encode(const std::vector<LoopEdge>& loops) {
  ByteWriter out;
  out.count(loops.size());
  for (const LoopEdge& loop : loops) {
    out.number(loop.a.value);
    out.number(loop.b.value);
    out.pose(loop.T_a_b);
    out.number(loop.sigma_m);
    out.number(loop.sigma_rad);
  }
  return out;
}

std::vector<LoopEdge> decode_loops(ByteReader content) {
  std::vector<LoopEdge> loops(content.count(24 + kPoseSize));
  for (LoopEdge& loop : loops) {
    loop.a = take_id<KeyframeId>(content);
    loop.b = take_id<KeyframeId>(content);
    loop.T_a_b = content.pose();
    loop.sigma_m = content.number<double>();
    loop.sigma_rad = content.number<double>();
  }
  content.finish();
  return loops;
}

ByteWriter encode(const FrameRecords& frames) {
  ByteWriter out;
  out.count(frames.size());
  for (const FrameRecord frame : frames) {
    put(out, frame.stamp);
    out.number(frame.reference.value);
    out.pose(frame.T_reference_frame);
  }
  return out;
}

FrameRecords decode_frames(ByteReader content) {
  FrameRecords frames;
  for (std::size_t left = content.count(16 + kPoseSize); left > 0; --left) {
    FrameRecord frame;
    frame.stamp = take_stamp(content);
    frame.reference = take_id<KeyframeId>(content);
    frame.T_reference_frame = content.pose();
    frames.push_back(std::move(frame));
  }
  content.finish();
  return frames;
}

ByteWriter encode(const ViewRecord& record) {
  ByteWriter out;
  out.number(record.frame);
  put(out, record.view->cloud);
  put(out, record.view->range);
  if (record.depth_after_color_s != 0) out.number(record.depth_after_color_s);
  return out;
}

ViewRecord decode_view(ByteReader content) {
  ViewRecord record;
  record.frame = content.number<std::uint32_t>();
  StaticView view;
  view.cloud = take_cloud(content);
  view.range = take_range(content);
  record.view = std::make_shared<const StaticView>(std::move(view));
  if (!content.at_end()) record.depth_after_color_s = content.number<double>();
  content.finish();
  return record;
}

}  // namespace stillmap
