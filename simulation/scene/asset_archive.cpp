// SPDX-License-Identifier: Apache-2.0
#include "simulation/scene/asset_archive.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>

#include <Eigen/LU>
#include <fmt/core.h>
#include <zip.h>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

constexpr std::string_view kCatalogue = "PluginFurnitureCatalog.properties";
constexpr std::size_t kMaxCatalogueBytes = std::size_t{4} << 20U;
constexpr double kMaxSize_cm = 5000.0;

// An entry's properties: "width#12=46.6" is {12, {"width", "46.6"}}.
using Properties = std::map<int, std::map<std::string, std::string, std::less<>>>;

Properties parse_properties(std::string_view text) {
  Properties properties;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    const std::size_t hash = line.find('#'), equals = line.find('=');
    if (hash == 0 || equals == std::string_view::npos || hash >= equals) continue;
    int number = 0;
    const char* last = line.data() + equals;
    const std::from_chars_result parsed = std::from_chars(line.data() + hash + 1, last, number);
    if (parsed.ec != std::errc() || parsed.ptr != last) continue;
    properties[number][std::string(line.substr(0, hash))] = line.substr(equals + 1);
  }
  return properties;
}

std::optional<double> parse_number(std::string_view text) {
  double value = 0;
  const std::from_chars_result parsed =
      std::from_chars(text.data(), text.data() + text.size(), value);
  if (parsed.ec != std::errc() || parsed.ptr != text.data() + text.size()) return std::nullopt;
  return std::isfinite(value) ? std::optional<double>(value) : std::nullopt;
}

// Nine numbers, row by row.
std::optional<Eigen::Matrix3d> parse_rotation(std::string_view text) {
  Eigen::Matrix3d rotation;
  for (int i = 0; i < 9; ++i) {
    text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
    const std::size_t end = std::min(text.find(' '), text.size());
    const std::optional<double> value = parse_number(text.substr(0, end));
    if (!value) return std::nullopt;
    rotation(i / 3, i % 3) = *value;
    text.remove_prefix(end);
  }
  const double off = (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm();
  return off < 0.02 && rotation.determinant() > 0 ? std::optional(rotation) : std::nullopt;
}

std::string stem_of(std::string_view entry) {
  const std::string_view file = entry.substr(entry.find_last_of('/') + 1);
  return std::string(file.substr(0, file.find_last_of('.')));
}

bool leads_out(std::string_view entry) {
  if (entry.empty() || entry.front() == '/' || entry.find('\\') != std::string_view::npos) {
    return true;
  }
  while (!entry.empty()) {
    const std::size_t end = std::min(entry.find('/'), entry.size());
    if (entry.substr(0, end) == "..") return true;
    entry.remove_prefix(std::min(end + 1, entry.size()));
  }
  return false;
}

class CatalogueReader {
 public:
  explicit CatalogueReader(std::string place) : place_(std::move(place)) {}

  [[nodiscard]] std::vector<CatalogueEntry> read(std::string_view text) const {
    std::vector<CatalogueEntry> entries;
    for (const auto& [number, values] : parse_properties(text)) {
      const auto model = values.find("model");
      if (model == values.end()) continue;
      CatalogueEntry entry;
      entry.model = model->second.substr(model->second.starts_with('/') ? 1 : 0);
      entry.name = stem_of(entry.model);
      const auto length_m = [&, n = number](std::string_view key, const auto& all) {
        return size_m(key, n, all);
      };
      entry.width_m = length_m("width", values);
      entry.depth_m = length_m("depth", values);
      entry.height_m = length_m("height", values);
      const auto rotation = values.find("modelRotation");
      if (rotation != values.end()) {
        const std::optional<Eigen::Matrix3d> parsed = parse_rotation(rotation->second);
        if (!parsed) {
          throw Error("{}: modelRotation#{} is '{}', expected the nine numbers of a rotation",
                      place_,
                      number,
                      rotation->second);
        }
        entry.rotation = *parsed;
      }
      entries.push_back(std::move(entry));
    }
    return entries;
  }

 private:
  [[nodiscard]] double size_m(std::string_view key,
                              int number,
                              const std::map<std::string, std::string, std::less<>>& values) const {
    const auto found = values.find(key);
    const std::string text = found == values.end() ? "" : found->second;
    const std::optional<double> size_cm = parse_number(text);
    if (!size_cm || *size_cm <= 0 || *size_cm > kMaxSize_cm) {
      throw Error("{}: {}#{} is '{}', expected centimetres above 0 and up to {}",
                  place_,
                  key,
                  number,
                  text,
                  kMaxSize_cm);
    }
    return *size_cm / 100.0;
  }

  std::string place_;
};

}  // namespace

/// An open zip file.
struct AssetArchive::Zip {
  explicit Zip(const std::filesystem::path& path) {
    int code = 0;
    handle = zip_open(path.c_str(), ZIP_RDONLY, &code);
    if (handle != nullptr) return;
    zip_error_t error;
    zip_error_init_with_code(&error, code);
    const std::string reason = zip_error_strerror(&error);
    zip_error_fini(&error);
    throw Error("{}: not a readable zip file ({}); reinstall the package that it is of",
                path.string(),
                reason);
  }
  ~Zip() { zip_discard(handle); }
  Zip(const Zip&) = delete;
  Zip& operator=(const Zip&) = delete;

  zip_t* handle;
};

AssetArchive::AssetArchive(const std::filesystem::path& path)
    : path_(path), zip_(std::make_shared<Zip>(path)) {
  const std::string name(kCatalogue);
  catalogue_ = CatalogueReader(place(name)).read(read(name, kMaxCatalogueBytes));
}

std::string AssetArchive::place(const std::string& entry) const {
  return fmt::format("{}: {}", path_.string(), entry);
}

const CatalogueEntry& AssetArchive::model(const std::string& name) const {
  const auto found = std::ranges::find(catalogue_, name, &CatalogueEntry::name);
  if (found == catalogue_.end()) {
    throw Error("{}: lists no model named '{}', only {} others",
                place(std::string(kCatalogue)),
                name,
                catalogue_.size());
  }
  return *found;
}

bool AssetArchive::contains(const std::string& entry) const {
  return zip_name_locate(zip_->handle, entry.c_str(), 0) >= 0;
}

std::string AssetArchive::read(const std::string& entry, std::size_t max_bytes) const {
  if (leads_out(entry)) {
    throw Error("{}: the name leads out of the archive, expected a plain path", place(entry));
  }
  zip_stat_t stat;
  zip_stat_init(&stat);
  if (zip_stat(zip_->handle, entry.c_str(), 0, &stat) != 0) {
    throw Error("{}: no such entry in the archive", place(entry));
  }
  if ((stat.valid & ZIP_STAT_SIZE) == 0 || stat.size > max_bytes) {
    throw Error("{}: {} bytes unpacked, expected at most {}", place(entry), stat.size, max_bytes);
  }
  zip_file_t* file = zip_fopen_index(zip_->handle, stat.index, 0);
  if (file == nullptr) {
    throw Error("{}: cannot be unpacked ({})", place(entry), zip_strerror(zip_->handle));
  }
  // One byte more than declared: an entry that has it contradicts its declaration.
  std::string bytes(stat.size + 1, '\0');
  const zip_int64_t count = zip_fread(file, bytes.data(), bytes.size());
  const std::string reason = zip_file_strerror(file);
  const bool closed = zip_fclose(file) == 0;
  if (count < 0 || static_cast<zip_uint64_t>(count) != stat.size || !closed) {
    throw Error("{}: damaged ({} of {} bytes can be unpacked: {})",
                place(entry),
                std::max<zip_int64_t>(count, 0),
                stat.size,
                reason);
  }
  bytes.pop_back();
  return bytes;
}

}  // namespace stillmap
