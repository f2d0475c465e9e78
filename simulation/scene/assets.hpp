// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "simulation/scene/asset_person.hpp"

namespace stillmap {

/// People and furniture of other authors, for an office that looks more like a photograph.
struct Assets {
  std::vector<PersonAsset> people;  ///< none or more
  std::vector<AssetModel> chairs;   ///< none or more; in the frame of make_chair(), as high
  std::string credits;              ///< authors and licences, in whole lines
};

/// The folder of the Debian package sweethome3d-furniture.
inline constexpr const char* kFurnitureFolder = "/usr/share/sweethome3d/furniture";

/// The assets of the furniture libraries in a folder; nothing if there is no library. Throws Error
/// for a damaged library.
[[nodiscard]] std::optional<Assets> installed_assets(
    const std::filesystem::path& folder = kFurnitureFolder);

}  // namespace stillmap
