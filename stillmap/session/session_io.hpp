// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "stillmap/session/session.hpp"

namespace stillmap {

// The file map.stillmap, whose layout docs/session-format.md has. A session that is read equals the
// one that was written bit by bit, except that its map knows nothing of landmarks that were merged.
// The same session gives the same bytes, on any machine.

/// Writes a session; the file appears as a whole. Takes little memory besides the session. Throws
/// Error when the file cannot be written, and for a session that read_session would refuse.
void write_session(const std::filesystem::path& path, const Session& session);

struct SessionReadOptions {
  /// Without, Session::views stays empty, and most of the file is not read: for localising.
  bool with_views = true;
};

/// Reads a session. The file may be anything: throws Error, one line that starts with its name, for
/// what is no session file, truncated, damaged, of a newer version, or holds what no session can;
/// takes little more memory than the file has bytes.
[[nodiscard]] Session read_session(const std::filesystem::path& path,
                                   const SessionReadOptions& options = {});

/// The same with bytes in memory; `name` stands for the file's in messages.
[[nodiscard]] std::string encode_session(const Session& session);
[[nodiscard]] Session decode_session(std::string_view bytes,
                                     const std::string& name,
                                     const SessionReadOptions& options = {});

}  // namespace stillmap
