// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace stillmap {

/// A model that an archive's catalogue lists. Its file has x to the model's left, y up and z to its
/// front, once turned by `rotation`.
struct CatalogueEntry {
  std::string name;   ///< of the model's file, without folder and ending: "office_chair"
  std::string model;  ///< the archive's entry: "scopia/office_chair/office_chair.obj"
  double width_m = 0;
  double depth_m = 0;
  double height_m = 0;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
};

/// A furniture library of Sweet Home 3D (*.sh3f): a zip file with models and a catalogue of them.
/// What is wrong with the file is an Error that names it and the entry.
class AssetArchive {
 public:
  /// Opens the archive and reads its catalogue.
  explicit AssetArchive(const std::filesystem::path& path);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  /// What the catalogue says of a model; an Error where it lists none of that name.
  [[nodiscard]] const CatalogueEntry& model(const std::string& name) const;

  [[nodiscard]] bool contains(const std::string& entry) const;

  /// The whole of an entry. An Error where there is none, where its name leads out of the archive,
  /// where it is damaged, or where it says to be larger than `max_bytes`, before that much is
  /// allocated.
  [[nodiscard]] std::string read(const std::string& entry, std::size_t max_bytes) const;

  /// Names a part of the archive in messages.
  [[nodiscard]] std::string place(const std::string& entry) const;

 private:
  struct Zip;

  std::filesystem::path path_;
  std::shared_ptr<Zip> zip_;
  std::vector<CatalogueEntry> catalogue_;
};

}  // namespace stillmap
