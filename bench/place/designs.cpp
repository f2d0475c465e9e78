// SPDX-License-Identifier: Apache-2.0
#include "bench/place/designs.hpp"

#include <algorithm>
#include <numeric>
#include <random>

#include "bench/place/bag_of_words.hpp"
#include "stillmap/core/random.hpp"

namespace stillmap {
namespace {

std::vector<std::vector<int>> draw_bits(int tables, int bits) {
  std::mt19937 rng(12345);
  std::vector<int> order(256);
  std::iota(order.begin(), order.end(), 0);
  std::vector<std::vector<int>> drawn;
  std::size_t used = order.size();
  for (int t = 0; t < tables; ++t) {
    if (used + static_cast<std::size_t>(bits) > order.size()) {
      for (std::uint32_t i = 256; i > 1; --i) std::swap(order[i - 1], order[draw_index(rng, i)]);
      used = 0;
    }
    const auto first = order.begin() + static_cast<std::ptrdiff_t>(used);
    drawn.emplace_back(first, first + bits);
    used += static_cast<std::size_t>(bits);
  }
  return drawn;
}

std::uint32_t key_of(const Descriptor& d, const std::vector<int>& bits) {
  std::uint32_t key = 0;
  for (const int bit : bits) {
    const auto b = static_cast<unsigned>(bit);
    key = (key << 1U) | static_cast<std::uint32_t>((d[b / 64U] >> (b % 64U)) & 1U);
  }
  return key;
}

class HashWords : public PlaceDesign {
 public:
  HashWords(int tables, int bits)
      : bits_(draw_bits(tables, bits)),
        shift_(static_cast<unsigned>(bits)),
        bags_(static_cast<std::size_t>(tables) << shift_) {}

  void add(std::span<const Descriptor> descriptors) override { bags_.add(words(descriptors)); }
  [[nodiscard]] std::vector<double> scores(std::span<const Descriptor> descriptors) const override {
    return bags_.scores(words(descriptors));
  }

 private:
  [[nodiscard]] std::vector<std::uint32_t> words(std::span<const Descriptor> descriptors) const {
    std::vector<std::uint32_t> words;
    for (const Descriptor& d : descriptors) {
      for (std::uint32_t t = 0; t < bits_.size(); ++t) {
        words.push_back((t << shift_) | key_of(d, bits_[t]));
      }
    }
    return words;
  }

  std::vector<std::vector<int>> bits_;
  unsigned shift_;
  BagOfWords bags_;
};

class IndexVoting : public PlaceDesign {
 public:
  explicit IndexVoting(const PlaceOptions& options) : index_(options) {}

  void add(std::span<const Descriptor> descriptors) override {
    index_.add(KeyframeId(static_cast<std::uint32_t>(index_.size())), descriptors);
  }
  [[nodiscard]] std::vector<double> scores(std::span<const Descriptor> descriptors) const override {
    std::vector<double> result(index_.size(), 0.0);
    for (const PlaceCandidate& candidate : index_.query(descriptors, index_.size())) {
      result[candidate.keyframe.index()] = candidate.score;
    }
    return result;
  }

 private:
  PlaceIndex index_;
};

}  // namespace

std::unique_ptr<PlaceDesign> hash_words(int tables, int bits) {
  return std::make_unique<HashWords>(tables, bits);
}
std::unique_ptr<PlaceDesign> place_index(const PlaceOptions& options) {
  return std::make_unique<IndexVoting>(options);
}

}  // namespace stillmap
