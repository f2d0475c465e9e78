// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "stillmap/session/bytes.hpp"

namespace stillmap {

// The outer structure of a session file: a head, then sections. docs/session-format.md has the
// layout.

inline constexpr std::string_view kSessionMagic = "stillmap";
inline constexpr std::uint32_t kSessionVersion = 4;
/// The oldest version that is read. What it can describe is written in it.
inline constexpr std::uint32_t kOldestSessionVersion = 2;
/// The first version that describes lenses with k4 to k6, and fish-eyes.
inline constexpr std::uint32_t kWideLensVersion = 3;
inline constexpr std::size_t kSessionHeadSize = 16;  ///< magic, version, checksum
inline constexpr std::size_t kSectionHeadSize = 12;  ///< tag, size of the content
inline constexpr std::size_t kSectionExtraSize =
    16;  ///< section head and the checksum after the content
inline constexpr std::size_t kMaxSectionSize = std::size_t{1} << 30U;
inline constexpr std::string_view kEndTag = "END ";

/// CRC-32 (IEEE 802.3, as in zlib) of bytes that follow bytes with the checksum `before`.
[[nodiscard]] std::uint32_t checksum(std::string_view bytes, std::uint32_t before = 0);

/// The bytes of a file head.
[[nodiscard]] std::string session_head(std::uint32_t version = kSessionVersion);

/// Writes head and sections.
class SectionWriter {
 public:
  using Sink = std::function<void(std::string_view)>;

  /// Writes the head.
  explicit SectionWriter(Sink sink, std::uint32_t version = kSessionVersion);
  /// Throws Error, with `place`, for a content of more than kMaxSectionSize.
  void write(std::string_view tag, const ByteWriter& content, const std::string& place);
  /// Writes the end. To be called once, last.
  void finish();

 private:
  void put(std::string_view tag, std::string_view content);

  Sink sink_;
  std::uint32_t sections_ = 0;
};

/// A source of bytes that is read in parts.
struct ByteSource {
  std::uint64_t size = 0;
  std::function<std::string(std::uint64_t offset, std::size_t size)> read;
};

/// Reads sections one after the other. The bytes need not be trusted: every function throws Error,
/// in one line that begins with the file name, for bytes that are no complete session file.
class SectionReader {
 public:
  /// Reads the head.
  SectionReader(ByteSource source, std::string file);

  /// Whether the next section has this tag.
  [[nodiscard]] bool at(std::string_view tag) const { return next_.tag == tag; }
  /// Reads the content of the next section, which must have this tag.
  [[nodiscard]] ByteReader read(std::string_view tag);
  /// Skips the next section without reading its content.
  void skip(std::string_view tag);
  /// Throws Error unless the end follows.
  void finish();

  [[nodiscard]] const std::string& file() const { return file_; }

 private:
  struct Head {
    std::string bytes;
    std::string tag;
    std::size_t size = 0;  // of the content
  };

  void read_head();
  void expect(std::string_view tag) const;
  [[nodiscard]] std::string place() const;  // of the next section
  [[nodiscard]] Error truncated() const;

  ByteSource source_;
  std::string file_;
  std::uint64_t at_ = kSessionHeadSize;  // position of the next section
  std::uint32_t sections_ = 0;           // number of sections before the next
  Head next_;
};

}  // namespace stillmap
