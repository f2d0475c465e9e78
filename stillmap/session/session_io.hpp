// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "stillmap/session/session.hpp"

namespace stillmap {

// The file map.stillmap (layout: docs/session-format.md). A session that is read equals the written
// one bit by bit, except that its map has no record of merged landmarks. The same session gives the
// same bytes on every machine.

/// Writes a session atomically. Takes little memory in addition to the session. Throws Error when
/// the file cannot be written, and for a session that read_session would refuse.
void write_session(const std::filesystem::path& path, const Session& session);
/// The same, piece by piece to `sink`. `place` begins the messages about the session.
void write_session(const std::function<void(std::string_view bytes)>& sink,
                   const Session& session,
                   const std::string& place);

struct SessionReadOptions {
  /// If false, Session::views stays empty and most of the file is not read. Localising needs no
  /// views.
  bool with_views = true;
};

/// Reads a session. The file need not be trusted: throws Error, in one line that begins with its
/// name, for a file that is no session, truncated, damaged, of another version, or inconsistent.
/// Takes little more memory than the file has bytes.
[[nodiscard]] Session read_session(const std::filesystem::path& path,
                                   const SessionReadOptions& options = {});

/// read_session for bytes in memory. Messages call them `name`.
[[nodiscard]] std::string encode_session(const Session& session);
[[nodiscard]] Session decode_session(std::string_view bytes,
                                     const std::string& name,
                                     const SessionReadOptions& options = {});

}  // namespace stillmap
