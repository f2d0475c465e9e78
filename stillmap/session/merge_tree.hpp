// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace stillmap {

/// Sessions that are one map.
struct MergedPart {
  std::filesystem::path file;  ///< the map: one of the given files, or one in the scratch folder
  std::vector<std::string> sessions;  ///< as given, the earliest first
  std::size_t keyframes = 0;
  std::size_t loops = 0;  ///< number of places by which these sessions were joined
};

/// Merges the sessions in `files` as a binary tree: neighbours in time, then pairs of these, and so
/// on. What has no place in common with the others of a pair stays a part of its own, and is tried
/// again one level above. The result does not depend on the order of `files`: sessions are sorted
/// by their first stamp, equal ones by the bytes of their files. A part has the coordinates and the
/// settings of its earliest session. The part with most key frames comes first.
///
/// Two maps and the one made of them are in memory at a time; merged maps are files in `scratch`,
/// an empty folder, and those that were merged further are removed. Throws Error when a file is no
/// session, and for a session of another camera or with other pyramid levels than one that it is
/// compared with.
[[nodiscard]] std::vector<MergedPart> merge_as_tree(const std::vector<std::filesystem::path>& files,
                                                    const std::filesystem::path& scratch);

}  // namespace stillmap
