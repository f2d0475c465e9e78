// SPDX-License-Identifier: Apache-2.0
// Any bytes are read as a session or refused with one line; what is read can be used and gives,
// when written, the same bytes. docs/fuzzing.md says how to run it.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "fuzz/session_mutator.hpp"
#include "stillmap/core/error.hpp"
#include "stillmap/dense/free_space.hpp"
#include "stillmap/dense/global_cloud.hpp"
#include "stillmap/session/session_io.hpp"
#include "stillmap/session/session_map.hpp"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace stillmap {
namespace {

void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", what);
  std::abort();
}

// What becomes of the views when a session's map is exported.
void assemble_cloud(const Session& session) {
  std::vector<PosedCloud> clouds;
  std::vector<PosedRange> ranges;
  for (const ViewRecord& view : session.views) {
    const Eigen::Isometry3d T = T_world_frame(session, session.frames[view.frame]);
    clouds.push_back({T, &view.view->cloud});
    if (view.view->range.columns > 0) ranges.push_back({T, &view.view->range});
  }
  const PointCloud all = global_cloud(clouds, 0.05);
  require(without_moved(all, ranges, session.camera, {}).size() <= all.size(), "fewer points");
}

void use(const Session& session) {
  session.map.check_consistency();
  std::size_t frames = 0;
  for (const SubmapId world : session.map.submaps()) {
    frames += trajectory_in(session, world).size();
    require(!keyframes_in(session, world).empty(), "a world has key frames");
  }
  require(frames == session.frames.size(), "each frame is in one world");
  require(main_submap(session).valid() == (frames > 0), "a main world");
  for (const auto& [id, keyframe] : session.map.keyframes()) {
    const Features& features = *keyframe.features;
    std::size_t all = 0;
    features.grid.visit_near({0, 0}, 1e9F, [&](std::uint32_t i) { all += i < features.size(); });
    require(all == features.size(), "each feature is in the grid");
  }
  assemble_cloud(session);
}

void try_bytes(std::string_view bytes) {
  try {
    const Session session = decode_session(bytes, "input");
    use(session);
    require(encode_session(session) == bytes, "the same bytes");
    const Session without = decode_session(bytes, "input", {.with_views = false});
    require(without.frames.size() == session.frames.size(), "the same frames");
  } catch (const Error& error) {
    const std::string text = error.what();
    require(text.starts_with("input: ") && text.find('\n') == std::string::npos, "one line");
  }
}

}  // namespace
}  // namespace stillmap

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  stillmap::try_bytes({reinterpret_cast<const char*>(data), size});
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data,
                                               std::size_t size,
                                               std::size_t max_size,
                                               unsigned int seed) {
  std::mt19937 rng(seed);
  const stillmap::ByteMutator mutate = [](std::string bytes, std::size_t most) {
    const std::size_t before = std::min(bytes.size(), most);
    bytes.resize(std::max<std::size_t>(most, 1));
    bytes.resize(
        LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(bytes.data()), before, bytes.size()));
    return bytes;
  };
  const std::string result =
      stillmap::mutate_session({reinterpret_cast<const char*>(data), size}, max_size, rng, mutate);
  std::copy(result.begin(), result.end(), data);
  return result.size();
}
