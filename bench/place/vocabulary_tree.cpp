// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <random>

#include "bench/place/bag_of_words.hpp"
#include "bench/place/designs.hpp"
#include "stillmap/core/random.hpp"

namespace stillmap {

/// Three levels; children of node n of a level are n * branching + c of the next.
struct VocabularyTree {
  std::size_t branching = 0;
  std::array<std::vector<Descriptor>, 3> levels;

  [[nodiscard]] std::uint32_t word(const Descriptor& d) const {
    std::size_t node = 0;
    for (const std::vector<Descriptor>& level : levels) {
      std::size_t best = node * branching;
      for (std::size_t c = best; c < (node + 1) * branching; ++c) {
        if (hamming_distance(d, level[c]) < hamming_distance(d, level[best])) best = c;
      }
      node = best;
    }
    return static_cast<std::uint32_t>(node);
  }
};

namespace {

Descriptor majority(const std::vector<Descriptor>& all, const std::vector<std::size_t>& chosen) {
  std::array<std::size_t, 256> ones{};
  for (const std::size_t i : chosen) {
    for (std::size_t b = 0; b < 256; ++b) ones[b] += (all[i][b / 64] >> (b % 64)) & 1U;
  }
  Descriptor result{};
  for (std::size_t b = 0; b < 256; ++b) {
    if (2 * ones[b] > chosen.size()) result[b / 64] |= std::uint64_t{1} << (b % 64);
  }
  return result;
}

struct Clusters {
  std::vector<Descriptor> centres;
  std::vector<std::vector<std::size_t>> members;
};

// k-majority: k-means with Hamming distance.
Clusters cluster(const std::vector<Descriptor>& all,
                 const std::vector<std::size_t>& chosen,
                 std::size_t count,
                 std::mt19937& rng) {
  Clusters clusters;
  for (std::size_t c = 0; c < count; ++c) {
    const auto n = static_cast<std::uint32_t>(chosen.size());
    clusters.centres.push_back(n > 0 ? all[chosen[draw_index(rng, n)]] : Descriptor{});
  }
  for (int round = 0; round < 8; ++round) {
    clusters.members.assign(count, {});
    for (const std::size_t i : chosen) {
      std::size_t best = 0;
      for (std::size_t c = 1; c < count; ++c) {
        if (hamming_distance(all[i], clusters.centres[c]) <
            hamming_distance(all[i], clusters.centres[best])) {
          best = c;
        }
      }
      clusters.members[best].push_back(i);
    }
    for (std::size_t c = 0; c < count; ++c) {
      if (!clusters.members[c].empty()) clusters.centres[c] = majority(all, clusters.members[c]);
    }
  }
  return clusters;
}

class VocabularyWords : public PlaceDesign {
 public:
  explicit VocabularyWords(std::shared_ptr<const VocabularyTree> tree)
      : tree_(std::move(tree)), bags_(tree_->levels.back().size()) {}

  void add(std::span<const Descriptor> descriptors) override { bags_.add(words(descriptors)); }
  [[nodiscard]] std::vector<double> scores(std::span<const Descriptor> descriptors) const override {
    return bags_.scores(words(descriptors));
  }

 private:
  [[nodiscard]] std::vector<std::uint32_t> words(std::span<const Descriptor> descriptors) const {
    std::vector<std::uint32_t> words;
    for (const Descriptor& d : descriptors) words.push_back(tree_->word(d));
    return words;
  }
  std::shared_ptr<const VocabularyTree> tree_;
  BagOfWords bags_;
};

}  // namespace

std::shared_ptr<const VocabularyTree> train_vocabulary(std::vector<Descriptor> training,
                                                       std::size_t branching) {
  std::mt19937 rng(1);
  auto tree = std::make_shared<VocabularyTree>();
  tree->branching = branching;
  std::vector<std::vector<std::size_t>> nodes(1);
  for (std::size_t i = 0; i < training.size(); ++i) nodes[0].push_back(i);
  for (std::vector<Descriptor>& level : tree->levels) {
    std::vector<std::vector<std::size_t>> next;
    for (const std::vector<std::size_t>& node : nodes) {
      Clusters clusters = cluster(training, node, branching, rng);
      level.insert(level.end(), clusters.centres.begin(), clusters.centres.end());
      next.insert(next.end(), clusters.members.begin(), clusters.members.end());
    }
    nodes = std::move(next);
  }
  return tree;
}

std::unique_ptr<PlaceDesign> vocabulary_words(std::shared_ptr<const VocabularyTree> tree) {
  return std::make_unique<VocabularyWords>(std::move(tree));
}

}  // namespace stillmap
