// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "simulation/scene/asset_person.hpp"

namespace stillmap {

/// People and furniture that somebody else made, for an office that looks more like a photograph.
struct Assets {
  std::vector<PersonAsset> people;  ///< none or more
  std::vector<AssetModel> chairs;   ///< none or more; in the frame of make_chair(), as high
  std::string credits;              ///< whose they are and under which licence, in whole lines
};

/// Where the Debian package sweethome3d-furniture puts its files.
inline constexpr const char* kFurnitureFolder = "/usr/share/sweethome3d/furniture";

/// What is used of the furniture libraries in a folder; nothing where it has none of them. A
/// library that is there but damaged is an Error.
[[nodiscard]] std::optional<Assets> installed_assets(
    const std::filesystem::path& folder = kFurnitureFolder);

}  // namespace stillmap
