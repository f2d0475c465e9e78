// SPDX-License-Identifier: Apache-2.0
#include "tooling/pipeline/live_record.hpp"

#include <algorithm>
#include <optional>
#include <sstream>

#include <nlohmann/json.hpp>

#include "stillmap/core/error.hpp"
#include "stillmap/io/atomic_file.hpp"

namespace stillmap {
namespace {

using Json = nlohmann::ordered_json;  // keys stay in the order in which they are written here

constexpr std::size_t kMaxBytes = std::size_t{1} << 28U;  // some 4 million frames

FrameId parse_frame(const Json& value, const std::string& place) {
  constexpr std::uint64_t kFrames = FrameId::kInvalidValue;
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() >= kFrames) {
    throw Error("{}: a frame that is no number from 0 to {}", place, kFrames - 1);
  }
  return FrameId(value.get<std::uint32_t>());
}

LiveStep parse_step(const std::string& line, const std::string& place) {
  const Json json = Json::parse(line, nullptr, false);
  if (!json.is_object() || !json.contains("frame") || !json.contains("objects_of") ||
      !json["objects_of"].is_array() || (json.contains("stamp") && !json["stamp"].is_string())) {
    throw Error(
        R"({}: expected {{"stamp":"1341846313.592026","frame":12,"objects_of":[9]}}, as live runs write it)",
        place);
  }
  LiveStep step{parse_frame(json["frame"], place), {}};
  if (json.contains("stamp")) step.stamp = json["stamp"].get<std::string>();
  for (const Json& value : json["objects_of"]) {
    step.objects_of.push_back(parse_frame(value, place));
  }
  return step;
}

}  // namespace

std::string live_jsonl(std::span<const LiveStep> record) {
  std::string lines;
  for (const LiveStep& step : record) {
    Json objects_of = Json::array();
    for (const FrameId id : step.objects_of) objects_of.push_back(id.value);
    const Json json = {
        {"stamp", step.stamp}, {"frame", step.frame.value}, {"objects_of", objects_of}};
    lines += json.dump() + "\n";
  }
  return lines;
}

LiveRecord read_live_record(const std::filesystem::path& file) {
  std::istringstream lines(read_file(file, kMaxBytes));
  LiveRecord record;
  std::optional<FrameId> last_looked_at;
  for (std::string line; std::getline(lines, line);) {
    const std::string place = fmt::format("{}:{}", file.string(), record.size() + 1);
    LiveStep step = parse_step(line, place);
    if (!record.empty() && step.frame <= record.back().frame) {
      throw Error("{}: frame {} does not come after frame {}",
                  place,
                  step.frame.value,
                  record.back().frame.value);
    }
    for (const FrameId id : step.objects_of) {
      const bool known =
          id == step.frame || std::ranges::binary_search(record, id, {}, &LiveStep::frame);
      if (!known || (last_looked_at && id <= *last_looked_at)) {
        throw Error("{}: objects of frame {}, which was not processed before or has had its turn",
                    place,
                    id.value);
      }
      last_looked_at = id;
    }
    record.push_back(std::move(step));
  }
  if (record.empty()) throw Error("{}: no frame in it", file.string());
  return record;
}

}  // namespace stillmap
