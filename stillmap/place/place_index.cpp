// SPDX-License-Identifier: Apache-2.0
#include "stillmap/place/place_index.hpp"

#include <algorithm>
#include <cmath>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

constexpr unsigned kBucketBits = 15;  // per table

// `bits` bits from `first` on, over the words' borders.
std::uint32_t bit_run(const Descriptor& d, unsigned first, unsigned bits) {
  const unsigned word = first / 64U, shift = first % 64U;
  std::uint64_t run = d[word] >> shift;
  if (shift + bits > 64U) run |= d[word + 1U] << (64U - shift);
  return static_cast<std::uint32_t>(run & ((std::uint64_t{1} << bits) - 1U));
}

}  // namespace

PlaceIndex::PlaceIndex(const PlaceOptions& options)
    : options_(options), buckets_(static_cast<std::size_t>(options.keys) << kBucketBits) {
  STILLMAP_CHECK(options.key_bits >= 8 && options.key_bits <= 32 && options.keys >= 1 &&
                 options.keys * options.key_bits <= kDescriptorBits);
}

std::size_t PlaceIndex::bucket(std::uint32_t table, std::uint32_t key) const {
  // Fibonacci hashing: neighbouring keys are spread over the table.
  return (std::size_t{table} << kBucketBits) | ((key * 2654435769U) >> (32U - kBucketBits));
}

std::vector<PlaceIndex::Key> PlaceIndex::distinctive_keys(
    std::span<const Descriptor> descriptors) const {
  const auto bits = static_cast<unsigned>(options_.key_bits);
  std::vector<Key> kept;
  kept.reserve(descriptors.size() * static_cast<std::size_t>(options_.keys));
  std::vector<std::uint64_t> keyed(descriptors.size());  // the key, then the feature
  for (std::uint32_t table = 0; table < static_cast<std::uint32_t>(options_.keys); ++table) {
    for (std::size_t i = 0; i < descriptors.size(); ++i) {
      keyed[i] = (std::uint64_t{bit_run(descriptors[i], table * bits, bits)} << 32U) | i;
    }
    std::ranges::sort(keyed);
    for (std::size_t begin = 0, end = 0; begin < keyed.size(); begin = end) {
      while (end < keyed.size() && (keyed[end] >> 32U) == (keyed[begin] >> 32U)) ++end;
      if (end - begin > static_cast<std::size_t>(options_.max_alike)) continue;
      for (std::size_t i = begin; i < end; ++i) {
        kept.push_back({table,
                        static_cast<std::uint32_t>(keyed[i] >> 32U),
                        static_cast<std::uint32_t>(keyed[i])});
      }
    }
  }
  return kept;
}

void PlaceIndex::add(KeyframeId keyframe, std::span<const Descriptor> descriptors) {
  STILLMAP_CHECK(keyframe.valid() && !has(keyframe) && descriptors.size() <= 65535);
  if (free_slots_.empty()) {
    free_slots_.push_back(static_cast<std::uint32_t>(places_.size()));
    places_.emplace_back();
  }
  const std::uint32_t slot = free_slots_.back();
  free_slots_.pop_back();
  slots_[keyframe] = slot;
  places_[slot] = {keyframe, {descriptors.begin(), descriptors.end()}};
  for (const Key& key : distinctive_keys(descriptors)) {
    buckets_[bucket(key.table, key.key)].push_back({key.key, slot, key.feature});
  }
}

void PlaceIndex::remove(KeyframeId keyframe) {
  const auto found = slots_.find(keyframe);
  if (found == slots_.end()) return;
  const std::uint32_t slot = found->second;
  for (const Key& key : distinctive_keys(places_[slot].descriptors)) {
    std::erase_if(buckets_[bucket(key.table, key.key)],
                  [&](const Entry& entry) { return entry.slot == slot; });
  }
  places_[slot] = {};
  free_slots_.push_back(slot);
  slots_.erase(found);
}

// Per slot, of those that are counted.
STILLMAP_POPCOUNT_CLONES
std::vector<double> PlaceIndex::votes(std::span<const Descriptor> descriptors,
                                      const std::vector<std::uint8_t>& counted) const {
  std::vector<std::vector<std::uint32_t>> found(descriptors.size());  // slots, per feature
  for (const Key& key : distinctive_keys(descriptors)) {
    const Descriptor& descriptor = descriptors[key.feature];
    std::vector<std::uint32_t>& slots = found[key.feature];
    for (const Entry& entry : buckets_[bucket(key.table, key.key)]) {
      if (entry.key != key.key || counted[entry.slot] == 0) continue;
      const Descriptor& other = places_[entry.slot].descriptors[entry.feature];
      if (hamming_distance(descriptor, other) <= options_.max_distance) {
        slots.push_back(entry.slot);
      }
    }
  }
  const auto places = static_cast<double>(std::ranges::count(counted, 1));
  std::vector<double> result(places_.size(), 0.0);
  for (std::vector<std::uint32_t>& slots : found) {
    std::ranges::sort(slots);
    slots.erase(std::unique(slots.begin(), slots.end()), slots.end());
    if (slots.empty()) continue;
    const double rarity = 1.0 - std::log(static_cast<double>(slots.size())) / std::log(places + 1);
    for (const std::uint32_t slot : slots) result[slot] += rarity;
  }
  return result;
}

std::vector<PlaceCandidate> PlaceIndex::query(std::span<const Descriptor> descriptors,
                                              std::size_t max_results,
                                              std::span<const KeyframeId> left_out) const {
  std::vector<std::uint8_t> counted(places_.size(), 0);
  for (const auto& [keyframe, slot] : slots_) counted[slot] = 1;
  for (const KeyframeId keyframe : left_out) {
    const auto found = slots_.find(keyframe);
    if (found != slots_.end()) counted[found->second] = 0;
  }
  const std::vector<double> sums = votes(descriptors, counted);
  std::vector<PlaceCandidate> candidates;
  for (const auto& [keyframe, slot] : slots_) {
    if (sums[slot] <= 0) continue;
    candidates.push_back({keyframe, sums[slot] / static_cast<double>(descriptors.size())});
  }
  // Stable over the map's order: ties by id.
  std::ranges::stable_sort(candidates,
                           [](const auto& l, const auto& r) { return l.score > r.score; });
  if (candidates.size() > max_results) candidates.resize(max_results);
  return candidates;
}

}  // namespace stillmap
