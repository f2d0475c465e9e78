// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace stillmap {

/// Places as bags of words, compared by tf-idf with the L1 score of Nister and Stewenius
/// (CVPR 2006): 1 for equal bags, 0 for bags that share no word.
class BagOfWords {
 public:
  using Bag = std::vector<std::pair<std::uint32_t, double>>;  // (word, frequency), by word

  explicit BagOfWords(std::size_t words) : postings_(words) {}

  static Bag bag_of(const std::vector<std::uint32_t>& words) {
    std::map<std::uint32_t, double> counts;
    for (const std::uint32_t word : words) counts[word] += 1.0 / static_cast<double>(words.size());
    return {counts.begin(), counts.end()};
  }

  void add(const std::vector<std::uint32_t>& words) {
    bags_.push_back(bag_of(words));
    const auto place = static_cast<std::uint32_t>(bags_.size() - 1);
    for (const auto& [word, frequency] : bags_.back()) {
      postings_[word].push_back({place, frequency});
    }
  }

  [[nodiscard]] std::vector<double> scores(const std::vector<std::uint32_t>& words) const {
    const auto count = static_cast<double>(bags_.size());
    const auto idf = [&](std::uint32_t word) {
      const auto with = static_cast<double>(postings_[word].size());
      return with > 0 ? std::log((count + 1) / with) : 0.0;
    };
    // A bag's weights depend on the current rarity of its words, so each query weighs the places.
    std::vector<double> norms(bags_.size(), 0.0), result(bags_.size(), 0.0);
    for (std::size_t place = 0; place < bags_.size(); ++place) {
      for (const auto& [word, frequency] : bags_[place]) norms[place] += frequency * idf(word);
    }
    const Bag query = bag_of(words);
    double norm = 0;
    for (const auto& [word, frequency] : query) norm += frequency * idf(word);
    for (const auto& [word, frequency] : query) {
      const double rarity = idf(word), q = frequency * rarity / norm;
      for (const auto& [place, other] : postings_[word]) {
        result[place] += std::min(q, other * rarity / norms[place]);
      }
    }
    return result;
  }

 private:
  std::vector<std::vector<std::pair<std::uint32_t, double>>> postings_;
  std::vector<Bag> bags_;
};

}  // namespace stillmap
