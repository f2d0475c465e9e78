// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "stillmap/core/ids.hpp"
#include "stillmap/slam/features/descriptor.hpp"
#include "stillmap/slam/map/map.hpp"

namespace stillmap {

/// How descriptors are looked up. A key is a run of bits of the descriptor.
struct PlaceOptions {
  int keys = 8;           ///< of each descriptor, 1 to 256 / key_bits
  int key_bits = 16;      ///< 8 to 32
  int max_distance = 30;  ///< Hamming; farther descriptors are of different corners
  int max_alike = 1;      ///< a key that more features of one image share is left out
};

struct PlaceCandidate {
  KeyframeId keyframe;
  double score = 0;  ///< 0 (nothing in common) to 1

  [[nodiscard]] bool operator==(const PlaceCandidate&) const = default;
};

/// Finds the key frames that look like an image, from binary descriptors alone.
///
/// Each descriptor is stored under several keys (multi-index hashing, Norouzi et al., CVPR 2012): a
/// descriptor of the same corner, with some bits flipped, still shares one of them. A feature of
/// the image that finds its like in a key frame votes for it, with less weight the more key frames
/// have it. Edges, which all look alike, share keys within one image and are left out. There is no
/// vocabulary to train or to load; docs/place-recognition.md compares this with such.
///
/// The answer depends on what is in the index alone, not on the order in which it came in. Queries
/// change nothing.
class PlaceIndex {
 public:
  explicit PlaceIndex(const PlaceOptions& options = {});

  /// The key frame is not in the index. At most 65535 descriptors.
  void add(KeyframeId keyframe, std::span<const Descriptor> descriptors);
  /// The same for many at once, faster. None is in the index, and none is given twice.
  struct NewPlace {
    KeyframeId keyframe;
    std::span<const Descriptor> descriptors;
  };
  void add(std::span<const NewPlace> places);
  /// Nothing happens when it is not in the index.
  void remove(KeyframeId keyframe);
  [[nodiscard]] bool has(KeyframeId keyframe) const { return slots_.contains(keyframe); }
  [[nodiscard]] std::size_t size() const { return slots_.size(); }

  /// At most `max_results` key frames with something in common, best first, ties by id. Those in
  /// `left_out` (in any order) do not count, as results or otherwise: the neighbours of the image,
  /// which look like it without being a loop.
  [[nodiscard]] std::vector<PlaceCandidate> query(std::span<const Descriptor> descriptors,
                                                  std::size_t max_results,
                                                  std::span<const KeyframeId> left_out = {}) const;

 private:
  struct Entry {
    std::uint32_t key;
    std::uint32_t slot;
    std::uint32_t feature;
  };
  struct Place {
    KeyframeId keyframe;  // invalid: free
    std::vector<Descriptor> descriptors;
  };
  /// Keys of an image's features; all of feature 0, then of feature 1, ...
  struct Keys {
    std::vector<std::uint32_t> keys;
    std::vector<std::uint8_t>
        distinctive;  // 0: more than max_alike of the image's features share it
  };

  [[nodiscard]] std::uint32_t take_slot(const NewPlace& place);
  void add_to_table(std::size_t table,
                    std::span<const std::uint32_t> slots,
                    std::span<const Keys> keys);
  [[nodiscard]] Keys keys_of(std::span<const Descriptor> descriptors) const;
  [[nodiscard]] std::size_t bucket(std::size_t table, std::uint32_t key) const;
  [[nodiscard]] std::vector<double> votes(std::span<const Descriptor> descriptors,
                                          const std::vector<std::uint8_t>& counted) const;

  PlaceOptions options_;
  std::vector<std::vector<Entry>> buckets_;
  std::vector<Place> places_;  // by slot
  std::map<KeyframeId, std::uint32_t> slots_;
  std::vector<std::uint32_t> free_slots_;
};

/// An index of all key frames of a map.
[[nodiscard]] PlaceIndex index_of(const Map& map);

}  // namespace stillmap
