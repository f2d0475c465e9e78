// SPDX-License-Identifier: Apache-2.0
// Any detections.jsonl, with any mask of its first frame, is read or refused; a line that is read
// is written and read again.
#include <algorithm>

#include <opencv2/core.hpp>

#include "fuzz/harness.hpp"
#include "stillmap/io/stamp_text.hpp"
#include "stillmap/perception/detections/detections_io.hpp"

namespace stillmap::fuzz {
namespace {

const cv::Size kImage(32, 24);

void read_folder(const MemoryFolder& folder, std::string_view mask) {
  const DetectionsFolder detections = DetectionsFolder::open(folder.path(), kImage);
  require(detections.size() > 0, "there are frames");
  if (mask.empty()) return;
  std::filesystem::create_directories(folder.path() / "masks");
  const std::filesystem::path file = folder.put("masks/1.5.png", mask);
  read_or_refuse([&] {
    const FrameDetections frame = detections.at({1.5, "1.5"});
    double most = 0;
    if (!frame.mask.mat.empty()) cv::minMaxLoc(frame.mask.mat, nullptr, &most);
    require(most == 0 || std::ranges::any_of(frame.objects,
                                             [&](const DetectedObject& object) {
                                               return object.id == static_cast<int>(most);
                                             }),
            "a pixel has an object of the list");
  });
  std::filesystem::remove(file);
}

void read(std::string_view bytes) {
  static const MemoryFolder folder;
  const std::vector<std::string_view> parts = parts_of(bytes, 2);
  (void)folder.put("detections.jsonl", parts[0]);
  read_or_refuse([&] { read_folder(folder, parts[1]); });
  read_or_refuse([&] {
    const std::string_view text = parts[0].substr(0, parts[0].find('\n'));
    const DetectionsLine line = parse_detections_line(text, kImage, "input");
    const std::string written = format_detections_line({line.stamp, line.objects, {}});
    const DetectionsLine again = parse_detections_line(written, kImage, "what was written");
    require(again.stamp.text == line.stamp.text && again.objects == line.objects, "the same line");
    require(parse_stamp(line.stamp.text).has_value(), "a stamp that all readers take");
    require(line.stamp.text.find('/') == std::string::npos, "a stamp is a name of a file");
  });
}

}  // namespace
}  // namespace stillmap::fuzz

STILLMAP_FUZZER(stillmap::fuzz::read)
