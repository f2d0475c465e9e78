// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/detections/detections_io.hpp"

#include <algorithm>
#include <array>
#include <system_error>
#include <utility>

#include <opencv2/core.hpp>

#include "stillmap/core/error.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "stillmap/io/image_io.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxListBytes = std::size_t{256} << 20U;
constexpr std::size_t kMaxLines = 1000000;

fs::path list_path(const fs::path& folder) {
  return folder / "detections.jsonl";
}

// A stamp is a plain number, so that the file cannot be outside this folder.
fs::path mask_path(const fs::path& folder, const Stamp& stamp) {
  return folder / "masks" / (stamp.text + ".png");
}

std::string line_place(const fs::path& folder, std::size_t number) {
  return fmt::format("{}:{}", list_path(folder).string(), number);
}

void remove_file(const fs::path& path) {
  std::error_code failure;
  fs::remove(path, failure);
  if (failure) throw Error("cannot remove {}: {}", path.string(), failure.message());
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
  if (mask.size() != image) {
    throw Error("{}: {}x{} pixels, expected {}x{} as the images have",
                path.string(),
                mask.cols,
                mask.rows,
                image.width,
                image.height);
  }
  const int id = unknown_id(mask, line.objects);
  if (id != 0) throw Error("{}: has pixels of id {}, which {} has not", path.string(), id, place);
}

}  // namespace

DetectionsWriter::DetectionsWriter(fs::path folder, cv::Size image)
    : folder_(std::move(folder)), image_(image) {
  STILLMAP_CHECK(image.width > 0 && image.height > 0);
  std::error_code failure;
  fs::create_directories(folder_ / "masks", failure);
  if (failure) {
    throw Error("{}: the folder cannot be made ({}); name one in a place that can be written to",
                (folder_ / "masks").string(),
                failure.message());
  }
  remove_file(list_path(folder_));
}

void DetectionsWriter::add(const FrameDetections& frame) {
  const std::string text = format_detections_line(frame);
  const std::string place = line_place(folder_, ++frames_);
  const DetectionsLine line = parse_detections_line(text, image_, place);
  check_order(line.stamp, last_stamp_s_, place);
  last_stamp_s_ = line.stamp.seconds;
  const fs::path path = mask_path(folder_, line.stamp);
  if (frame.mask.mat.empty()) {
    remove_file(path);  // from an earlier run
  } else {
    check_mask(frame.mask.mat, line, image_, path, place);
    write_file_atomically(path, encode_mask_png(frame.mask.mat));
  }
  list_ += text;
  list_ += '\n';
}

void DetectionsWriter::finish() {
  write_file_atomically(list_path(folder_), list_);
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
  return detections;
}

void DetectionsFolder::add_line(std::string_view text, std::size_t number) {
  if (text.find_first_not_of(" \t\r") == std::string_view::npos) return;
  const std::string place = line_place(folder_, number);
  if (number > kMaxLines) throw Error("{}: more than {} lines", place, kMaxLines);
  DetectionsLine line = parse_detections_line(text, image_, place);
  check_order(line.stamp, lines_.empty() ? -1.0 : lines_.back().line.stamp.seconds, place);
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
  check_mask(mask, entry.line, image_, path, line_place(folder_, entry.number));
  return cv::countNonZero(mask) == 0 ? ObjectMask() : ObjectMask(mask);
}

}  // namespace stillmap
