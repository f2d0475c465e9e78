// SPDX-License-Identifier: Apache-2.0
#include "stillmap/io/ply.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "stillmap/core/error.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "stillmap/io/ply_header.hpp"

namespace stillmap {
namespace {

static_assert(std::endian::native == std::endian::little,
              "values are copied as they are in memory");

constexpr std::size_t kMaxPlyBytes = std::size_t{4} << 30U;

// The values of a point, in this order, whatever their order in a file.
enum Slot : std::size_t { kX, kY, kZ, kRed, kGreen, kBlue, kLabel, kNx, kNy, kNz, kSlots };
constexpr std::array<std::string_view, kSlots> kSlotNames = {
    "x", "y", "z", "red", "green", "blue", "label", "nx", "ny", "nz"};

using SlotColumns = std::array<std::optional<std::size_t>, kSlots>;
using SlotValues = std::array<double, kSlots>;

void append_floats(std::string& bytes, const Eigen::Vector3f& v) {
  std::array<char, sizeof(float) * 3> raw;
  std::memcpy(raw.data(), v.data(), raw.size());
  bytes.append(raw.data(), raw.size());
}

bool has(const SlotColumns& columns, Slot slot) {
  return columns[slot].has_value();
}

// The column of the file for each slot; the first of equal names.
SlotColumns find_columns(const PlyHeader& header, const std::string& name) {
  SlotColumns columns;
  for (std::size_t slot = 0; slot < kSlots; ++slot) {
    const auto found = std::ranges::find(header.properties, kSlotNames[slot], &PlyProperty::name);
    if (found != header.properties.end()) {
      columns[slot] = static_cast<std::size_t>(found - header.properties.begin());
    }
  }
  if (!has(columns, kX) || !has(columns, kY) || !has(columns, kZ)) {
    throw Error("{}: the vertices lack x, y or z", name);
  }
  if (has(columns, kRed) != has(columns, kGreen) || has(columns, kRed) != has(columns, kBlue)) {
    throw Error("{}: the vertices have only some of red, green, blue", name);
  }
  if (has(columns, kNx) != has(columns, kNy) || has(columns, kNx) != has(columns, kNz)) {
    throw Error("{}: the vertices have only some of nx, ny, nz", name);
  }
  return columns;
}

template <class T>
double load(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return static_cast<double>(value);
}

double load(PlyType type, const char* bytes) {
  switch (type) {
    case PlyType::kInt8:
      return load<std::int8_t>(bytes);
    case PlyType::kUint8:
      return load<std::uint8_t>(bytes);
    case PlyType::kInt16:
      return load<std::int16_t>(bytes);
    case PlyType::kUint16:
      return load<std::uint16_t>(bytes);
    case PlyType::kInt32:
      return load<std::int32_t>(bytes);
    case PlyType::kUint32:
      return load<std::uint32_t>(bytes);
    case PlyType::kFloat:
      return load<float>(bytes);
    case PlyType::kDouble:
      return load<double>(bytes);
  }
  return 0.0;
}

// Collects points into a cloud and checks their values.
class CloudBuilder {
 public:
  CloudBuilder(const PlyHeader& header, const SlotColumns& columns, std::string name)
      : columns_(columns), name_(std::move(name)) {
    cloud_.positions.reserve(header.vertices);
    cloud_.colors.reserve(header.vertices);
    if (has(columns, kLabel)) cloud_.labels.reserve(header.vertices);
    if (has(columns, kNx)) cloud_.normals.reserve(header.vertices);
  }

  void add(const SlotValues& values) {
    cloud_.positions.push_back(vector(values, kX));
    if (!cloud_.positions.back().allFinite()) {
      throw Error("{}: the position of vertex {} is not finite", name_, cloud_.size() - 1);
    }
    const bool colored = has(columns_, kRed);
    cloud_.colors.push_back(colored
                                ? Rgb{byte(values, kRed), byte(values, kGreen), byte(values, kBlue)}
                                : Rgb{128, 128, 128});
    if (has(columns_, kLabel)) cloud_.labels.push_back(byte(values, kLabel));
    if (has(columns_, kNx)) cloud_.normals.push_back(vector(values, kNx));
  }

  [[nodiscard]] PointCloud take() { return std::move(cloud_); }

 private:
  [[nodiscard]] static Eigen::Vector3f vector(const SlotValues& values, Slot first) {
    return Eigen::Vector3d(values[first], values[first + 1], values[first + 2]).cast<float>();
  }

  [[nodiscard]] std::uint8_t byte(const SlotValues& values, Slot slot) const {
    const double value = values[slot];
    if (value >= 0.0 && value <= 255.0 && value == std::floor(value)) {
      return static_cast<std::uint8_t>(value);
    }
    throw Error("{}: {} of vertex {} is {}, expected a whole number from 0 to 255",
                name_,
                kSlotNames[slot],
                cloud_.size() - 1,
                value);
  }

  const SlotColumns& columns_;
  std::string name_;
  PointCloud cloud_;
};

PointCloud read_binary(const PlyHeader& header, std::string_view data, const std::string& name) {
  const SlotColumns columns = find_columns(header, name);
  std::vector<std::size_t> offsets;
  std::size_t stride = 0;
  for (const PlyProperty& property : header.properties) {
    offsets.push_back(stride);
    stride += byte_size(property.type);
  }
  const std::size_t room = data.size() - std::min(data.size(), header.vertex_offset);
  if (header.vertices > room / stride) {
    throw Error("{}: {} vertices of {} bytes in the header, but only {} bytes for them",
                name,
                header.vertices,
                stride,
                room);
  }
  CloudBuilder builder(header, columns, name);
  SlotValues values = {};
  const char* vertex = data.data() + std::min(data.size(), header.vertex_offset);
  for (std::size_t i = 0; i < header.vertices; ++i, vertex += stride) {
    for (std::size_t slot = 0; slot < kSlots; ++slot) {
      const std::optional<std::size_t> column = columns[slot];
      if (column) values[slot] = load(header.properties[*column].type, vertex + offsets[*column]);
    }
    builder.add(values);
  }
  return builder.take();
}

// Splits off the next line. Nothing at the end of the data.
std::optional<std::string_view> take_line(std::string_view& data) {
  if (data.empty()) return std::nullopt;
  const std::size_t end = std::min(data.find('\n'), data.size());
  const std::string_view line = data.substr(0, end);
  data.remove_prefix(std::min(end + 1, data.size()));
  return line;
}

// Reads `numbers.size()` numbers separated by blanks. False when the line has fewer, or other text.
bool parse_numbers(std::string_view line, std::span<double> numbers) {
  const char* at = line.data();
  const char* end = at + line.size();
  const auto skip_blanks = [&] { at = std::find_if(at, end, [](char c) { return c > ' '; }); };
  for (double& number : numbers) {
    skip_blanks();
    const auto [parsed, status] = std::from_chars(at, end, number);
    if (status != std::errc()) return false;
    at = parsed;
  }
  skip_blanks();
  return at == end;
}

PointCloud read_ascii(const PlyHeader& header, std::string_view data, const std::string& name) {
  const SlotColumns columns = find_columns(header, name);
  std::vector<double> numbers(header.properties.size());
  if (header.vertices >
      data.size() / (2 * numbers.size()) + 1) {  // a number takes a digit and a blank at least
    throw Error("{}: {} vertices in the header, but only {} bytes for them",
                name,
                header.vertices,
                data.size());
  }
  CloudBuilder builder(header, columns, name);
  SlotValues values = {};
  const std::size_t lines = header.vertex_line + header.vertices;
  for (std::size_t i = 0; i < lines; ++i) {
    const std::optional<std::string_view> line = take_line(data);
    if (!line) throw Error("{}: the file ends before its last vertex", name);
    if (i < header.vertex_line) continue;
    if (!parse_numbers(*line, numbers)) {
      throw Error("{}:{}: expected {} numbers", name, header.header_lines + i + 1, numbers.size());
    }
    for (std::size_t slot = 0; slot < kSlots; ++slot) {
      if (columns[slot]) values[slot] = numbers[*columns[slot]];
    }
    builder.add(values);
  }
  return builder.take();
}

void append_binary(std::string& bytes, const PointCloud& cloud, std::size_t i) {
  append_floats(bytes, cloud.positions[i]);
  for (const std::uint8_t channel : cloud.colors[i]) bytes += static_cast<char>(channel);
  bytes += static_cast<char>(cloud.labels.empty() ? 0 : cloud.labels[i]);
  if (!cloud.normals.empty()) append_floats(bytes, cloud.normals[i]);
}

void append_ascii(std::string& text, const PointCloud& cloud, std::size_t i) {
  const Eigen::Vector3f& p = cloud.positions[i];
  const Rgb& color = cloud.colors[i];
  const int label = cloud.labels.empty() ? 0 : cloud.labels[i];
  text +=
      fmt::format("{} {} {} {} {} {} {}", p.x(), p.y(), p.z(), color[0], color[1], color[2], label);
  if (!cloud.normals.empty()) {
    const Eigen::Vector3f& n = cloud.normals[i];
    text += fmt::format(" {} {} {}", n.x(), n.y(), n.z());
  }
  text += '\n';
}

}  // namespace

std::string encode_ply(const PointCloud& cloud, PlyFormat format) {
  const std::size_t count = cloud.size();
  STILLMAP_CHECK(cloud.colors.size() == count);
  STILLMAP_CHECK(cloud.labels.empty() || cloud.labels.size() == count);
  STILLMAP_CHECK(cloud.normals.empty() || cloud.normals.size() == count);
  const bool binary = format == PlyFormat::kBinary;
  const bool with_normals = !cloud.normals.empty();
  std::string bytes = fmt::format(
      "ply\nformat {} 1.0\nelement vertex {}\n"
      "property float x\nproperty float y\nproperty float z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar label\n{}"
      "end_header\n",
      binary ? "binary_little_endian" : "ascii",
      count,
      with_normals ? "property float nx\nproperty float ny\nproperty float nz\n" : "");
  bytes.reserve(bytes.size() + count * ((binary ? 16U : 40U) + (with_normals ? 12U : 0U)));
  for (std::size_t i = 0; i < count; ++i) {
    binary ? append_binary(bytes, cloud, i) : append_ascii(bytes, cloud, i);
  }
  return bytes;
}

PointCloud read_ply(const std::filesystem::path& path) {
  const std::string bytes = read_file(path, kMaxPlyBytes);
  const PlyHeader header = parse_ply_header(bytes, path.string());
  const std::string_view data = std::string_view(bytes).substr(header.header_bytes);
  return header.binary ? read_binary(header, data, path.string())
                       : read_ascii(header, data, path.string());
}

}  // namespace stillmap
