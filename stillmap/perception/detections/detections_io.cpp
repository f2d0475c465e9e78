// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/detections/detections_io.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include <opencv2/core.hpp>

#include "stillmap/core/error.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "stillmap/io/image_io.hpp"
#include "stillmap/io/stamp_text.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxListBytes = std::size_t{256} << 20U;
constexpr std::size_t kMaxLines = 1000000;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

fs::path list_path(const fs::path& folder) {
  return folder / "detections.jsonl";
}

// A stamp is a number, so the file cannot be outside this folder.
fs::path mask_path(const fs::path& folder, const Stamp& stamp) {
  return folder / "masks" / (stamp.text + ".png");
}

// Masks of other names are those of other programs.
bool is_file_of_detections(const fs::path& name) {
  const bool is_mask = name.parent_path() == "masks" && name.extension() == ".png" &&
                       parse_stamp(name.stem().string()).has_value();
  return is_mask || name == "detections.jsonl";
}

std::string line_place(const fs::path& folder, std::size_t number) {
  return fmt::format("{}:{}", list_path(folder).string(), number);
}

void check_order(const Stamp& stamp, double previous_s, const std::string& place) {
  if (stamp.seconds > previous_s) return;
  throw Error(
      "{}: stamp {} is not later than the line before, expected one line a frame in the "
      "order of stamps",
      place,
      stamp.text);
}

// An id in the mask that no object has; 0 if there is none.
int unknown_id(const cv::Mat1b& mask, const std::vector<DetectedObject>& objects) {
  std::array<bool, 256> unknown{};
  for (const std::uint8_t id : mask) unknown[id] = true;
  unknown[0] = false;
  for (const DetectedObject& object : objects) unknown[static_cast<std::size_t>(object.id)] = false;
  const auto found = std::ranges::find(unknown, true);
  return found == unknown.end() ? 0 : static_cast<int>(found - unknown.begin());
}

void check_mask(const cv::Mat1b& mask,
                const DetectionsLine& line,
                cv::Size image,
                const fs::path& path,
                const std::string& place) {
  check_mask_size(mask, image, path);
  const int id = unknown_id(mask, line.objects);
  if (id != 0) throw Error("{}: has pixels of id {}, which {} has not", path.string(), id, place);
}

// The extent of an object's pixels in the mask; empty if it has none.
PixelBox extent_of(const cv::Mat1b& mask, int id) {
  int x0 = mask.cols, y0 = mask.rows, x1 = 0, y1 = 0;
  for (int row = 0; row < mask.rows; ++row) {
    const std::uint8_t* const pixels = mask.ptr(row);
    for (int x = 0; x < mask.cols; ++x) {
      if (pixels[x] != id) continue;
      x0 = std::min(x0, x);
      x1 = std::max(x1, x + 1);
      y0 = std::min(y0, row);
      y1 = row + 1;
    }
  }
  if (x1 == 0) return {};
  return {static_cast<double>(x0),
          static_cast<double>(y0),
          static_cast<double>(x1),
          static_cast<double>(y1)};
}

// Whether a box, give or take a tenth of its size, has the extent of the object's pixels.
bool fits(const PixelBox& box, const PixelBox& extent) {
  constexpr double kLeast_px = 4, kShare = 0.1;
  const double across = std::max(kLeast_px, kShare * box.width());
  const double down = std::max(kLeast_px, kShare * box.height());
  return std::abs(box.x0 - extent.x0) <= across && std::abs(box.x1 - extent.x1) <= across &&
         std::abs(box.y0 - extent.y0) <= down && std::abs(box.y1 - extent.y1) <= down;
}

// Refuses boxes of another format: those that fit the pixels of every object with pixels as [x, y,
// width, height] and of none as [x0, y0, x1, y1].
void check_box_format(const cv::Mat1b& mask, const DetectionsLine& line, const std::string& place) {
  const DetectedObject* first = nullptr;
  for (const DetectedObject& object : line.objects) {
    const PixelBox extent = extent_of(mask, object.id);
    if (extent.area() <= 0) continue;
    const PixelBox& box = object.box;
    const PixelBox by_size{box.x0, box.y0, box.x0 + box.x1, box.y0 + box.y1};
    if (fits(box, extent) || !fits(by_size, extent)) return;
    if (first == nullptr) first = &object;
  }
  if (first == nullptr) return;
  throw Error(
      "{}: object {}: box [{}, {}, {}, {}] fits its pixels as [x, y, width, height], expected "
      "[x0, y0, x1, y1]",
      place,
      first->id,
      first->box.x0,
      first->box.y0,
      first->box.x1,
      first->box.y1);
}

// Whether a box lies in the image's first pixel, as a box in shares of the image size does.
bool is_share(const DetectedObject& object) {
  constexpr double kLargest = 1.5;
  return object.box.x1 <= kLargest && object.box.y1 <= kLargest;
}

}  // namespace

DetectionsWriter::DetectionsWriter(const fs::path& folder, cv::Size image)
    : own_(std::make_unique<FolderReplacement>(folder, is_file_of_detections)),
      result_(*own_),
      folder_(folder),
      image_(image) {
  STILLMAP_CHECK(image.width > 0 && image.height > 0);
}

DetectionsWriter::DetectionsWriter(const FolderReplacement& result,
                                   const fs::path& name,
                                   cv::Size image)
    : result_(result), folder_(name), name_(name), image_(image) {
  STILLMAP_CHECK(image.width > 0 && image.height > 0);
}

void DetectionsWriter::add(const FrameDetections& frame) {
  const std::string text = format_detections_line(frame);
  const std::string place = line_place(folder_, ++frames_);
  const DetectionsLine line = parse_detections_line(text, image_, place);
  check_order(line.stamp, last_stamp_s_, place);
  last_stamp_s_ = line.stamp.seconds;
  if (!frame.mask.mat.empty()) {
    check_mask(frame.mask.mat, line, image_, mask_path(folder_, line.stamp), place);
    result_.write(mask_path(name_, line.stamp), encode_mask_png(frame.mask.mat));
  }
  list_ += text;
  list_ += '\n';
}

void DetectionsWriter::finish() {
  result_.write(list_path(name_), list_);
  if (own_) own_->take_place();
}

DetectionsFolder DetectionsFolder::open(const fs::path& folder, cv::Size image) {
  STILLMAP_CHECK(image.width > 0 && image.height > 0);
  DetectionsFolder detections;
  detections.folder_ = folder;
  detections.image_ = image;
  const std::string text = read_file(list_path(folder), kMaxListBytes);
  std::string_view rest = text;
  for (std::size_t number = 1; !rest.empty(); ++number) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    detections.add_line(rest.substr(0, end), number);
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  if (detections.lines_.empty()) {
    throw Error("{}: no frame in it, expected a line for each colour image",
                list_path(folder).string());
  }
  detections.check_pixels();
  return detections;
}

void DetectionsFolder::check_pixels() const {
  const Entry* first = nullptr;
  for (const Entry& entry : lines_) {
    if (!std::ranges::all_of(entry.line.objects, is_share)) return;
    if (first == nullptr && !entry.line.objects.empty()) first = &entry;
  }
  if (first == nullptr) return;
  const PixelBox& box = first->line.objects.front().box;
  throw Error(
      "{}: box [{}, {}, {}, {}] is one pixel large at most, as are all boxes of this file: "
      "expected "
      "[x0, y0, x1, y1] in pixels, not in shares of the image from 0 to 1",
      line_place(folder_, first->number),
      box.x0,
      box.y0,
      box.x1,
      box.y1);
}

void DetectionsFolder::add_line(std::string_view text, std::size_t number) {
  if (text.find_first_not_of(" \t\r") == std::string_view::npos) return;
  const std::string place = line_place(folder_, number);
  if (number > kMaxLines) throw Error("{}: more than {} lines", place, kMaxLines);
  DetectionsLine line = parse_detections_line(text, image_, place);
  check_order(line.stamp, lines_.empty() ? -kInfinity : lines_.back().line.stamp.seconds, place);
  lines_.push_back({std::move(line), number});
}

const DetectionsFolder::Entry* DetectionsFolder::find(const Stamp& stamp) const {
  const auto seconds = [](const Entry& entry) { return entry.line.stamp.seconds; };
  const auto found = std::ranges::lower_bound(lines_, stamp.seconds, {}, seconds);
  if (found == lines_.end() || seconds(*found) != stamp.seconds) return nullptr;
  return &*found;
}

bool DetectionsFolder::contains(const Stamp& stamp) const {
  return find(stamp) != nullptr;
}

FrameDetections DetectionsFolder::at(const Stamp& stamp) const {
  const Entry* entry = find(stamp);
  if (entry == nullptr) {
    throw Error(
        "{}: no line for the image of stamp {}; were these detections made from another "
        "sequence?",
        list_path(folder_).string(),
        stamp.text);
  }
  return {entry->line.stamp, entry->line.objects, read_object_mask(*entry)};
}

ObjectMask DetectionsFolder::read_object_mask(const Entry& entry) const {
  const fs::path path = mask_path(folder_, entry.line.stamp);
  if (!path_exists(path)) return ObjectMask();
  const cv::Mat1b mask = read_mask(path);
  const std::string place = line_place(folder_, entry.number);
  check_mask(mask, entry.line, image_, path, place);
  check_box_format(mask, entry.line, place);
  return cv::countNonZero(mask) == 0 ? ObjectMask() : ObjectMask(mask);
}

}  // namespace stillmap
