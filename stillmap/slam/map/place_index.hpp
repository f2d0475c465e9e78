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

/// Options of the lookup of descriptors. A key is a run of bits of the descriptor.
struct PlaceOptions {
  int keys = 8;           ///< number of keys of a descriptor, 1 to 256 / key_bits
  int key_bits = 16;      ///< 8 to 32
  int max_distance = 30;  ///< Hamming distance; farther descriptors are of different corners
  int max_alike = 1;      ///< a key shared by more features of one image is left out
};

struct PlaceCandidate {
  KeyframeId keyframe;
  double score = 0;  ///< 0 (nothing in common) to 1

  [[nodiscard]] bool operator==(const PlaceCandidate&) const = default;
};

/// Finds the key frames that look like an image, by binary descriptors alone.
///
/// Each descriptor is stored under several keys (multi-index hashing, Norouzi et al., CVPR 2012): a
/// descriptor of the same corner, with some bits flipped, still shares one of them. A feature of
/// the image votes for each key frame with a similar descriptor, with a weight that falls with the
/// number of such key frames. Features on edges, which all look alike, share keys within one image
/// and are left out. There is no vocabulary to train or load; docs/place-recognition.md has a
/// comparison.
///
/// Results depend on the content of the index alone, not on the order of insertion. Queries change
/// nothing.
class PlaceIndex {
 public:
  explicit PlaceIndex(const PlaceOptions& options = {});

  /// Adds a key frame that is not in the index, with at most 65535 descriptors.
  void add(KeyframeId keyframe, std::span<const Descriptor> descriptors);
  /// Adds many key frames at once, which is faster. None may be in the index or be given twice.
  struct NewPlace {
    KeyframeId keyframe;
    std::span<const Descriptor> descriptors;
  };
  void add(std::span<const NewPlace> places);
  /// Removes a key frame. Does nothing if it is not in the index.
  void remove(KeyframeId keyframe);
  [[nodiscard]] bool has(KeyframeId keyframe) const { return slots_.contains(keyframe); }
  [[nodiscard]] std::size_t size() const { return slots_.size(); }

  /// At most `max_results` key frames with similar features, best first, ties by id. Key frames in
  /// `left_out` (in any order) are ignored: the neighbours of the image, which look like it but
  /// form no loop.
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
    KeyframeId keyframe;  // invalid for a free slot
    std::vector<Descriptor> descriptors;
  };
  /// The keys of an image's features: those of feature 0, then of feature 1, ...
  struct Keys {
    std::vector<std::uint32_t> keys;
    std::vector<std::uint8_t>
        distinctive;  // 0 if more than max_alike features of the image share the key
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

/// The place index of all key frames of a map.
[[nodiscard]] PlaceIndex index_of(const Map& map);

}  // namespace stillmap
