// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/map/place_index.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

constexpr unsigned kBucketBits = 15;  // per table

// `bits` bits from bit `first` on, across word boundaries.
std::uint32_t bit_run(const Descriptor& d, unsigned first, unsigned bits) {
  const unsigned word = first / 64U, shift = first % 64U;
  std::uint64_t run = d[word] >> shift;
  if (shift + bits > 64U) run |= d[word + 1U] << (64U - shift);
  return static_cast<std::uint32_t>(run & ((std::uint64_t{1} << bits) - 1U));
}

// Fibonacci hashing: spreads neighbouring keys over 2^bits buckets.
std::uint32_t hashed(std::uint32_t key, unsigned bits) {
  return (key * 2654435769U) >> (32U - bits);
}

// Counts the features of an image with each key.
class KeyCounts {
 public:
  explicit KeyCounts(std::size_t features)
      : bits_(static_cast<unsigned>(std::bit_width(4 * features + 8))),
        cells_(std::size_t{1} << bits_) {}

  void clear() { std::ranges::fill(cells_, Cell{}); }
  void add(std::uint32_t key) {
    Cell& cell = cells_[find(key)];
    cell.key = key;
    ++cell.count;
  }
  [[nodiscard]] int count(std::uint32_t key) const { return cells_[find(key)].count; }

 private:
  struct Cell {
    std::uint32_t key = 0;
    int count = 0;
  };
  // The cell of the key, or the empty cell where it belongs. At most a quarter of the cells is
  // used.
  [[nodiscard]] std::size_t find(std::uint32_t key) const {
    std::size_t at = hashed(key, bits_);
    while (cells_[at].count > 0 && cells_[at].key != key) at = (at + 1) & (cells_.size() - 1);
    return at;
  }

  unsigned bits_;
  std::vector<Cell> cells_;
};

}  // namespace

PlaceIndex::PlaceIndex(const PlaceOptions& options)
    : options_(options), buckets_(static_cast<std::size_t>(options.keys) << kBucketBits) {
  STILLMAP_CHECK(options.key_bits >= 8 && options.key_bits <= 32 && options.keys >= 1 &&
                 options.keys * options.key_bits <= kDescriptorBits);
}

std::size_t PlaceIndex::bucket(std::size_t table, std::uint32_t key) const {
  return (table << kBucketBits) | hashed(key, kBucketBits);
}

PlaceIndex::Keys PlaceIndex::keys_of(std::span<const Descriptor> descriptors) const {
  const auto count = static_cast<std::size_t>(options_.keys);
  const auto bits = static_cast<unsigned>(options_.key_bits);
  Keys result;
  result.keys.resize(descriptors.size() * count);
  result.distinctive.resize(result.keys.size());
  KeyCounts counts(descriptors.size());
  for (std::size_t table = 0; table < count; ++table) {
    counts.clear();
    for (std::size_t i = 0; i < descriptors.size(); ++i) {
      std::uint32_t& key = result.keys[i * count + table];
      key = bit_run(descriptors[i], static_cast<unsigned>(table) * bits, bits);
      counts.add(key);
    }
    for (std::size_t k = table; k < result.keys.size(); k += count) {
      result.distinctive[k] = counts.count(result.keys[k]) <= options_.max_alike ? 1 : 0;
    }
  }
  return result;
}

std::uint32_t PlaceIndex::take_slot(const NewPlace& place) {
  const auto& [keyframe, descriptors] = place;
  STILLMAP_CHECK(keyframe.valid() && !has(keyframe) && descriptors.size() <= 65535);
  if (free_slots_.empty()) {
    free_slots_.push_back(static_cast<std::uint32_t>(places_.size()));
    places_.emplace_back();
  }
  const std::uint32_t slot = free_slots_.back();
  free_slots_.pop_back();
  slots_[keyframe] = slot;
  places_[slot] = {keyframe, {descriptors.begin(), descriptors.end()}};
  return slot;
}

void PlaceIndex::add(KeyframeId keyframe, std::span<const Descriptor> descriptors) {
  const std::uint32_t slot = take_slot({keyframe, descriptors});
  const Keys keys = keys_of(descriptors);
  const auto count = static_cast<std::size_t>(options_.keys);
  for (std::size_t k = 0; k < keys.keys.size(); ++k) {
    if (keys.distinctive[k] == 0) continue;
    buckets_[bucket(k % count, keys.keys[k])].push_back(
        {keys.keys[k], slot, static_cast<std::uint32_t>(k / count)});
  }
}

void PlaceIndex::add(std::span<const NewPlace> places) {
  std::vector<std::uint32_t> slots;
  std::vector<Keys> keys;
  for (const NewPlace& place : places) {
    slots.push_back(take_slot(place));
    keys.push_back(keys_of(place.descriptors));
  }
  for (std::size_t table = 0; table < static_cast<std::size_t>(options_.keys); ++table) {
    add_to_table(table, slots, keys);
  }
}

// Table by table, since the buckets of a table are near each other; each bucket is allocated with
// its final size at once.
void PlaceIndex::add_to_table(std::size_t table,
                              std::span<const std::uint32_t> slots,
                              std::span<const Keys> keys) {
  const auto count = static_cast<std::size_t>(options_.keys);
  const std::size_t first = bucket(table, 0);
  std::vector<std::uint32_t> more(std::size_t{1} << kBucketBits, 0);
  for (const Keys& of_place : keys) {
    for (std::size_t k = table; k < of_place.keys.size(); k += count) {
      if (of_place.distinctive[k] != 0) ++more[bucket(table, of_place.keys[k]) - first];
    }
  }
  for (std::size_t b = 0; b < more.size(); ++b) {
    if (more[b] > 0) buckets_[first + b].reserve(buckets_[first + b].size() + more[b]);
  }
  for (std::size_t p = 0; p < keys.size(); ++p) {
    for (std::size_t k = table; k < keys[p].keys.size(); k += count) {
      if (keys[p].distinctive[k] == 0) continue;
      buckets_[bucket(table, keys[p].keys[k])].push_back(
          {keys[p].keys[k], slots[p], static_cast<std::uint32_t>(k / count)});
    }
  }
}

void PlaceIndex::remove(KeyframeId keyframe) {
  const auto found = slots_.find(keyframe);
  if (found == slots_.end()) return;
  const std::uint32_t slot = found->second;
  const Keys keys = keys_of(places_[slot].descriptors);
  for (std::size_t k = 0; k < keys.keys.size(); ++k) {
    if (keys.distinctive[k] == 0) continue;
    std::vector<Entry>& entries =
        buckets_[bucket(k % static_cast<std::size_t>(options_.keys), keys.keys[k])];
    std::erase_if(entries, [&](const Entry& entry) { return entry.slot == slot; });
    // Else every key that was ever seen would hold memory.
    if (entries.empty()) entries.shrink_to_fit();
  }
  places_[slot] = {};
  free_slots_.push_back(slot);
  slots_.erase(found);
}

// Per slot, of the key frames that count.
STILLMAP_POPCOUNT_CLONES
std::vector<double> PlaceIndex::votes(std::span<const Descriptor> descriptors,
                                      const std::vector<std::uint8_t>& counted) const {
  const auto places = static_cast<double>(std::ranges::count(counted, 1));
  const auto count = static_cast<std::size_t>(options_.keys);
  const Keys keys = keys_of(descriptors);
  std::vector<double> result(places_.size(), 0.0);
  std::vector<std::size_t> voted(places_.size(),
                                 descriptors.size());  // the last feature that voted
  std::vector<std::uint32_t> found;
  std::vector<Entry> sharing;
  for (std::size_t i = 0; i < descriptors.size(); ++i) {
    // First all entries, then their descriptors, so that memory accesses overlap.
    sharing.clear();
    for (std::size_t table = 0; table < count; ++table) {
      if (keys.distinctive[i * count + table] == 0) continue;
      const std::uint32_t key = keys.keys[i * count + table];
      for (const Entry& entry : buckets_[bucket(table, key)]) {
        if (entry.key != key || counted[entry.slot] == 0) continue;
        __builtin_prefetch(&places_[entry.slot].descriptors[entry.feature]);
        sharing.push_back(entry);
      }
    }
    found.clear();
    for (const Entry& entry : sharing) {
      if (voted[entry.slot] == i) continue;
      const Descriptor& other = places_[entry.slot].descriptors[entry.feature];
      if (hamming_distance(descriptors[i], other) > options_.max_distance) continue;
      voted[entry.slot] = i;
      found.push_back(entry.slot);
    }
    if (found.empty()) continue;
    const double rarity = 1.0 - std::log(static_cast<double>(found.size())) / std::log(places + 1);
    for (const std::uint32_t slot : found) result[slot] += rarity;
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
  // Stable over the order of the map, so that ties are by id.
  std::ranges::stable_sort(candidates,
                           [](const auto& l, const auto& r) { return l.score > r.score; });
  if (candidates.size() > max_results) candidates.resize(max_results);
  return candidates;
}

PlaceIndex index_of(const Map& map) {
  std::vector<PlaceIndex::NewPlace> places;
  for (const auto& [id, keyframe] : map.keyframes()) {
    places.push_back({id, keyframe.features->descriptors});
  }
  PlaceIndex index;
  index.add(places);
  return index;
}

}  // namespace stillmap
