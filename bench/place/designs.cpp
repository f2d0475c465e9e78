// SPDX-License-Identifier: Apache-2.0
#include "bench/place/designs.hpp"

#include <algorithm>
#include <numeric>
#include <random>

#include "bench/place/bag_of_words.hpp"
#include "stillmap/core/random.hpp"
#include "stillmap/features/matcher.hpp"

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

class HashVoting : public PlaceDesign {
 public:
  explicit HashVoting(const VotingOptions& options)
      : options_(options),
        bits_(draw_bits(options.tables, options.bits)),
        buckets_(static_cast<std::size_t>(options.tables) << static_cast<unsigned>(options.bits)) {}

  void add(std::span<const Descriptor> descriptors) override {
    const std::uint32_t place = places_++;
    for (const Descriptor& d : descriptors) {
      for (std::uint32_t t = 0; t < bits_.size(); ++t) {
        bucket(t, key_of(d, bits_[t])).push_back({place, d});
      }
    }
  }

  [[nodiscard]] std::vector<double> scores(std::span<const Descriptor> descriptors) const override {
    std::vector<double> result(places_, 0.0);
    std::vector<std::uint32_t> last(places_, 0), found;
    std::uint32_t round = 0;
    for (const Descriptor& d : descriptors) {
      ++round;
      found.clear();
      for (std::uint32_t t = 0; t < bits_.size(); ++t) {
        const std::uint32_t key = key_of(d, bits_[t]);
        look(t, key, d, round, last, found);
        for (int flip = 0; options_.probe && flip < options_.bits; ++flip) {
          look(t, key ^ (1U << static_cast<unsigned>(flip)), d, round, last, found);
        }
      }
      if (found.empty()) continue;
      // What is found in many places tells little.
      const double rarity =
          std::log((places_ + 1.0) / static_cast<double>(found.size())) / std::log(places_ + 1.0);
      for (const std::uint32_t place : found) {
        result[place] += rarity / static_cast<double>(descriptors.size());
      }
    }
    return result;
  }

 private:
  struct Entry {
    std::uint32_t place;
    Descriptor descriptor;
  };
  using Bucket = std::vector<Entry>;

  Bucket& bucket(std::uint32_t t, std::uint32_t key) {
    return buckets_[(static_cast<std::size_t>(t) << static_cast<unsigned>(options_.bits)) | key];
  }
  void look(std::uint32_t t,
            std::uint32_t key,
            const Descriptor& d,
            std::uint32_t round,
            std::vector<std::uint32_t>& last,
            std::vector<std::uint32_t>& found) const {
    const Bucket& bucket =
        buckets_[(static_cast<std::size_t>(t) << static_cast<unsigned>(options_.bits)) | key];
    if (bucket.size() > options_.max_bucket) return;
    for (const Entry& entry : bucket) {
      if (last[entry.place] == round) continue;
      if (hamming_distance(d, entry.descriptor) > options_.max_distance) continue;
      last[entry.place] = round;
      found.push_back(entry.place);
    }
  }

  VotingOptions options_;
  std::vector<std::vector<int>> bits_;
  std::uint32_t places_ = 0;
  std::vector<Bucket> buckets_;
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

class AllPairs : public PlaceDesign {
 public:
  AllPairs(int max_distance, double max_ratio) : rules_{max_distance, max_ratio} {}

  void add(std::span<const Descriptor> descriptors) override {
    places_.push_back(features_of(descriptors));
  }
  [[nodiscard]] std::vector<double> scores(std::span<const Descriptor> descriptors) const override {
    const Features query = features_of(descriptors);
    std::vector<std::uint32_t> all(descriptors.size());
    std::iota(all.begin(), all.end(), 0U);
    std::vector<double> result;
    for (const Features& place : places_) {
      result.push_back(static_cast<double>(match_all(query, all, place, rules_).size()) /
                       static_cast<double>(descriptors.size()));
    }
    return result;
  }

 private:
  static Features features_of(std::span<const Descriptor> descriptors) {
    Features features;
    features.descriptors.assign(descriptors.begin(), descriptors.end());
    features.px.resize(descriptors.size());
    return features;
  }
  MatchRules rules_;
  std::vector<Features> places_;
};

}  // namespace

std::unique_ptr<PlaceDesign> hash_words(int tables, int bits) {
  return std::make_unique<HashWords>(tables, bits);
}
std::unique_ptr<PlaceDesign> hash_voting(const VotingOptions& options) {
  return std::make_unique<HashVoting>(options);
}
std::unique_ptr<PlaceDesign> place_index(const PlaceOptions& options) {
  return std::make_unique<IndexVoting>(options);
}
std::unique_ptr<PlaceDesign> all_pairs(int max_distance, double max_ratio) {
  return std::make_unique<AllPairs>(max_distance, max_ratio);
}

}  // namespace stillmap
