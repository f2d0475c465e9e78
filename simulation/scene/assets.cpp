// SPDX-License-Identifier: Apache-2.0
#include "simulation/scene/assets.hpp"

#include <array>
#include <string_view>

#include <fmt/core.h>

#include "stillmap/core/error.hpp"
#include "stillmap/core/joined.hpp"
#include "stillmap/io/atomic_file.hpp"

namespace stillmap {
namespace {

constexpr double kSeatTop_m = 0.46;
constexpr double kBackTop_m = 0.92;

struct ChairModel {
  std::string_view library;
  std::string_view name;
  double seat_m;   // the height of its seat
  double front_m;  // shift to the front that makes the sitter's back meet the chair's
  double left_m;
};
constexpr std::array<ChairModel, 2> kChairs{{
    {"Scopia", "office_chair", 0.487, -0.04, -0.016},
    {"KatorLegaz", "office-chair", 0.498, -0.04, 0.0},
}};

struct Library {
  std::string_view name;
  std::string_view credit;
};
constexpr std::array<Library, 3> kLibraries{{
    {"Reallusion",
     "people: (C) Reallusion, http://www.reallusion.com/, Creative Commons Attribution 3.0 US "
     "(http://creativecommons.org/licenses/by/3.0/us/); adapted to move"},
    {"Scopia",
     "chairs: (C) Scopia Visual Interfaces Systems, s.l., http://www.scopia.es, and Emmanuel "
     "Puybaret / eTeks, Creative Commons Attribution 3.0 Unported "
     "(http://creativecommons.org/licenses/by/3.0/); adapted in size"},
    {"KatorLegaz",
     "chairs: (C) Andrew Kator & Jennifer Legaz, Creative Commons Attribution 3.0 US "
     "(http://creativecommons.org/licenses/by/3.0/us/); adapted in size"},
}};

// A chair scaled to the seat and back heights of make_chair(), for which people's poses are made.
AssetModel load_chair(const AssetArchive& archive, const ChairModel& chair) {
  const CatalogueEntry& entry = archive.model(std::string(chair.name));
  AssetModel model = load_model(archive, entry);
  const double below = kSeatTop_m / chair.seat_m;
  const double above = (kBackTop_m - kSeatTop_m) / (entry.height_m - chair.seat_m);
  for (Eigen::Vector3f& p : model.mesh.positions) {
    const double z = p.z();
    const double over = z - chair.seat_m;
    p.z() = static_cast<float>(over < 0 ? z * below : kSeatTop_m + over * above);
    p.x() += static_cast<float>(chair.front_m);
    p.y() += static_cast<float>(chair.left_m);
  }
  return model;
}

void add_library(Assets& assets, const AssetArchive& archive, const Library& library) {
  std::vector<std::string> names;
  if (library.name == "Reallusion") {
    assets.people = load_people(archive);
    for (const PersonAsset& person : assets.people) names.push_back(person.model.name);
  }
  for (const ChairModel& chair : kChairs) {
    if (chair.library != library.name) continue;
    assets.chairs.push_back(load_chair(archive, chair));
    names.push_back(assets.chairs.back().name);
  }
  assets.credits +=
      fmt::format("{}.sh3f ({}): {}\n", library.name, joined(names, ", "), library.credit);
}

}  // namespace

std::optional<Assets> installed_assets(const std::filesystem::path& folder) {
  Assets assets;
  for (const Library& library : kLibraries) {
    const std::filesystem::path file = folder / fmt::format("{}.sh3f", library.name);
    if (!path_exists(file)) continue;
    add_library(assets, AssetArchive(file), library);
  }
  if (assets.people.empty() && assets.chairs.empty()) return std::nullopt;
  return assets;
}

}  // namespace stillmap
