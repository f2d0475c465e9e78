// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "stillmap/slam/features/descriptor.hpp"
#include "stillmap/slam/map/place_index.hpp"

namespace stillmap {

/// A method to find places. Places are numbered in the order in which they were added.
class PlaceDesign {
 public:
  PlaceDesign() = default;
  PlaceDesign(const PlaceDesign&) = delete;
  PlaceDesign& operator=(const PlaceDesign&) = delete;
  virtual ~PlaceDesign() = default;
  virtual void add(std::span<const Descriptor> descriptors) = 0;
  /// The similarity of every place added so far to this one; higher is more similar.
  [[nodiscard]] virtual std::vector<double> scores(
      std::span<const Descriptor> descriptors) const = 0;
};

struct NamedDesign {
  std::string name;
  std::function<std::unique_ptr<PlaceDesign>()> make;
};

/// (a) Bags of words, with bits of the descriptor as words: `tables` words of `bits` bits each.
[[nodiscard]] std::unique_ptr<PlaceDesign> hash_words(int tables, int bits);

/// (b) Bags of words of a tree of `branching`^3 words, made of `training` descriptors.
struct VocabularyTree;
[[nodiscard]] std::shared_ptr<const VocabularyTree> train_vocabulary(
    std::vector<Descriptor> training, std::size_t branching);
[[nodiscard]] std::unique_ptr<PlaceDesign> vocabulary_words(
    std::shared_ptr<const VocabularyTree> tree);

/// (c) Descriptors vote for places with similar descriptors: stillmap::PlaceIndex.
[[nodiscard]] std::unique_ptr<PlaceDesign> place_index(const PlaceOptions& options);

}  // namespace stillmap
