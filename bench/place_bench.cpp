// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include "stillmap/slam/map/place_index.hpp"
#include "tests/support/feature_images.hpp"

namespace stillmap {
namespace {

// 300 key frames of 1000 features along a path: each sees some features of the previous one, with
// some bits changed, and a fifth of the features lie on edges, which all look alike.
struct Way {
  TestDice dice{1};
  Descriptor edge = dice.descriptor();
  std::vector<std::vector<Descriptor>> views;

  Way() {
    views.push_back({});
    for (int i = 0; i < 1000; ++i) views[0].push_back(dice.descriptor());
    while (views.size() < 300) {
      std::vector<Descriptor> next;
      for (const Descriptor& d : views.back()) {
        const int kind = dice.integer(0, 9);
        next.push_back(kind < 2   ? dice.flipped(edge, 8)
                       : kind < 5 ? dice.descriptor()
                                  : dice.flipped(d, 12));
      }
      views.push_back(std::move(next));
    }
  }
};

void query_300_of_1000(benchmark::State& state) {
  const Way way;
  PlaceIndex index;
  for (std::uint32_t k = 0; k < way.views.size(); ++k) index.add(KeyframeId(k), way.views[k]);
  std::size_t next = 0;
  for (auto iteration : state) {
    benchmark::DoNotOptimize(index.query(way.views[next++ % way.views.size()], 10));
  }
}

void add_and_remove(benchmark::State& state) {
  const Way way;
  PlaceIndex index;
  for (std::uint32_t k = 1; k < way.views.size(); ++k) index.add(KeyframeId(k), way.views[k]);
  for (auto iteration : state) {
    index.add(KeyframeId(0), way.views[0]);
    index.remove(KeyframeId(0));
  }
}

BENCHMARK(query_300_of_1000)->Unit(benchmark::kMillisecond);
BENCHMARK(add_and_remove)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace stillmap
