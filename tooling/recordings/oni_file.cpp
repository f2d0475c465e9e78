// SPDX-License-Identifier: Apache-2.0
#include "tooling/recordings/oni_file.hpp"

#include <array>
#include <bit>
#include <cstring>
#include <optional>
#include <string_view>

#include "stillmap/core/error.hpp"
#include "stillmap/io/image_io.hpp"

namespace stillmap {
namespace {

static_assert(std::endian::native == std::endian::little, "records are little-endian");

constexpr std::string_view kOniMagic = "NI10";
constexpr std::uint32_t kRecordMagic = 0x0052494E;  // "NIR"
constexpr std::size_t kFileHead = 24, kRecordHead = 28;
constexpr std::uint32_t kMostFields = 1U << 16U;

// Types of records.
constexpr std::uint32_t kInteger = 3, kGeneral = 6, kData = 10, kEnd = 11;
constexpr std::array<std::uint32_t, 3> kNodeAdded = {2, 12, 13};  // of several versions

// Types of nodes.
constexpr std::uint32_t kDepthNode = 2, kImageNode = 3;

// Reads fields one after the other; nothing more once one is missing.
class OniFields {
 public:
  explicit OniFields(std::string_view bytes) : rest_(bytes) {}

  template <class Number>
  [[nodiscard]] std::optional<Number> number() {
    if (rest_.size() < sizeof(Number)) return std::nullopt;
    Number value{};
    std::memcpy(&value, rest_.data(), sizeof(Number));
    rest_.remove_prefix(sizeof(Number));
    return value;
  }
  // With its size before it and a zero at its end.
  [[nodiscard]] std::string text() {
    const std::size_t size = number<std::uint32_t>().value_or(0);
    if (size > rest_.size()) return {};
    std::string text(rest_.substr(0, size));
    rest_.remove_prefix(size);
    if (!text.empty() && text.back() == '\0') text.pop_back();
    return text;
  }
  [[nodiscard]] std::string_view bytes(std::size_t count) const { return rest_.substr(0, count); }

 private:
  std::string_view rest_;
};

void set_integer(OniStream& stream, const std::string& name, std::uint64_t value) {
  constexpr std::uint64_t kTenthsOfMillimetres = 101;
  if (name == "xnMirror") stream.mirrored = value != 0;
  if (name == "oniPixelFormat" && value == kTenthsOfMillimetres) stream.units_per_m = 10000;
}

void set_general(OniStream& stream, const std::string& name, OniFields fields) {
  constexpr std::uint32_t kMostSidePx = 8192;
  if (name == "xnMapOutputMode") {
    const std::uint32_t width = fields.number<std::uint32_t>().value_or(0);
    const std::uint32_t height = fields.number<std::uint32_t>().value_or(0);
    if (width <= kMostSidePx && height <= kMostSidePx) {
      stream.size = {static_cast<int>(width), static_cast<int>(height)};
    }
  } else if (name == "xnFOV" || name == "xnFieldOfView") {
    stream.across_rad = fields.number<double>().value_or(0);
    stream.down_rad = fields.number<double>().value_or(0);
  }
}

}  // namespace

struct OniFile::Record {
  std::uint32_t type, node;
  std::string fields;
  std::uint64_t payload;  // where it is
  std::uint32_t payload_bytes;
};

OniFile::OniFile(const std::filesystem::path& path) : path_(path.string()), file_(path) {
  if (file_.size() < kFileHead || file_.read(0, kOniMagic.size()) != kOniMagic) {
    throw Error("{}: no recording of OpenNI, which begins with {}", path.string(), kOniMagic);
  }
  list_records();
}

void OniFile::list_records() {
  std::uint64_t at = kFileHead;
  while (at + kRecordHead <= file_.size()) {
    const std::string head = file_.read(at, kRecordHead);
    OniFields fields(head);
    const std::uint32_t magic = *fields.number<std::uint32_t>();
    Record record{*fields.number<std::uint32_t>(), *fields.number<std::uint32_t>(), {}, 0, 0};
    const std::uint32_t before = *fields.number<std::uint32_t>();  // head and fields
    record.payload = at + before;
    record.payload_bytes = *fields.number<std::uint32_t>();
    const bool whole = magic == kRecordMagic && before >= kRecordHead && before <= kMostFields &&
                       record.payload + record.payload_bytes <= file_.size();
    if (!whole) break;
    record.fields = file_.read(at + kRecordHead, before - kRecordHead);
    if (record.type == kEnd) return;
    take(record);
    at = record.payload + record.payload_bytes;
  }
  rest_ = file_.size() - at;
}

void OniFile::take(const Record& record) {
  OniFields fields(record.fields);
  if (std::ranges::find(kNodeAdded, record.type) != kNodeAdded.end()) {
    OniStream stream;
    stream.name = fields.text();
    const std::uint32_t node = fields.number<std::uint32_t>().value_or(0);
    stream.kind = node == kDepthNode   ? OniKind::kDepth
                  : node == kImageNode ? OniKind::kColor
                                       : OniKind::kOther;
    stream.codec = fields.bytes(4);
    stream_of_node_[record.node] = streams_.size();
    streams_.push_back(std::move(stream));
    return;
  }
  const auto found = stream_of_node_.find(record.node);
  if (found == stream_of_node_.end()) return;
  OniStream& stream = streams_[found->second];
  if (record.type == kData) {
    stream.images.push_back(
        {fields.number<std::uint64_t>().value_or(0), record.payload, record.payload_bytes});
  } else if (record.type == kInteger || record.type == kGeneral) {
    const std::string name = fields.text();
    (void)fields.number<std::uint32_t>();  // the size of the value
    if (record.type == kInteger) {
      set_integer(stream, name, fields.number<std::uint64_t>().value_or(0));
    } else {
      set_general(stream, name, fields);
    }
  }
}

std::string OniFile::read(const OniImage& image) const {
  constexpr std::uint32_t kMostBytes = 256U << 20U;
  if (image.bytes > kMostBytes) {
    throw DamagedImage("{}: an image of {} bytes, at most 256 MiB", path_, image.bytes);
  }
  return file_.read(image.offset, image.bytes);
}

bool is_oni(const std::filesystem::path& path) {
  try {
    const InputFile file(path);
    return file.size() >= kFileHead && file.read(0, kOniMagic.size()) == kOniMagic;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace stillmap
