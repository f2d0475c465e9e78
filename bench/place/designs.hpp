// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "stillmap/features/descriptor.hpp"
#include "stillmap/place/place_index.hpp"

namespace stillmap {

/// A way to find places, to be compared with others: places are numbered as they were added.
class PlaceDesign {
 public:
  PlaceDesign() = default;
  PlaceDesign(const PlaceDesign&) = delete;
  PlaceDesign& operator=(const PlaceDesign&) = delete;
  virtual ~PlaceDesign() = default;
  virtual void add(std::span<const Descriptor> descriptors) = 0;
  /// How much every place added so far looks like this one; more is more alike.
  [[nodiscard]] virtual std::vector<double> scores(
      std::span<const Descriptor> descriptors) const = 0;
};

struct NamedDesign {
  std::string name;
  std::function<std::unique_ptr<PlaceDesign>()> make;
};

/// (a) Bags of words that are bits of the descriptor: `tables` words of `bits` bits each.
[[nodiscard]] std::unique_ptr<PlaceDesign> hash_words(int tables, int bits);

/// (b) Bags of words of a tree of `branching`^3 words, made of `training` descriptors.
struct VocabularyTree;
[[nodiscard]] std::shared_ptr<const VocabularyTree> train_vocabulary(
    std::vector<Descriptor> training, std::size_t branching);
[[nodiscard]] std::unique_ptr<PlaceDesign> vocabulary_words(
    std::shared_ptr<const VocabularyTree> tree);

/// (c) Each descriptor looks for its like in `tables` hash tables of `bits` bits, where it also
/// tries the keys that differ in one bit if `probe`; like is nearer than `max_distance`.
struct VotingOptions {
  int tables = 4;
  int bits = 16;
  bool probe = false;
  int max_distance = 50;
  std::size_t max_bucket = 100000;  ///< a fuller one tells nothing
};
[[nodiscard]] std::unique_ptr<PlaceDesign> hash_voting(const VotingOptions& options);

/// (c) as stillmap::PlaceIndex does it.
[[nodiscard]] std::unique_ptr<PlaceDesign> place_index(const PlaceOptions& options);

/// No index: mutual best matches, as many comparisons as there are pairs of descriptors.
[[nodiscard]] std::unique_ptr<PlaceDesign> all_pairs(int max_distance, double max_ratio);

}  // namespace stillmap
