// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace stillmap {

/// A model in the catalogue of an archive. After `rotation`, its file has x to the model's left, y
/// up and z to its front.
struct CatalogueEntry {
  std::string name;   ///< of the model's file, without folder and ending: "office_chair"
  std::string model;  ///< the archive's entry: "scopia/office_chair/office_chair.obj"
  double width_m = 0;
  double depth_m = 0;
  double height_m = 0;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
};

/// A furniture library of Sweet Home 3D (*.sh3f): a zip file with models and their catalogue. All
/// functions throw Error, naming the file and the entry, for a wrong file.
class AssetArchive {
 public:
  /// Opens the archive and reads its catalogue.
  explicit AssetArchive(const std::filesystem::path& path);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  /// The catalogue entry of a model. Throws Error if there is none of that name.
  [[nodiscard]] const CatalogueEntry& model(const std::string& name) const;

  [[nodiscard]] bool contains(const std::string& entry) const;

  /// The content of an entry. Throws Error for a missing or damaged entry, a name that leads out of
  /// the archive, and a declared size over `max_bytes`; never allocates more than `max_bytes`.
  [[nodiscard]] std::string read(const std::string& entry, std::size_t max_bytes) const;

  /// The name of a part of the archive, for messages.
  [[nodiscard]] std::string place(const std::string& entry) const;

 private:
  struct Zip;

  std::filesystem::path path_;
  std::shared_ptr<Zip> zip_;
  std::vector<CatalogueEntry> catalogue_;
};

}  // namespace stillmap
