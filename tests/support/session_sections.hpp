// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "stillmap/session/sections.hpp"

namespace stillmap {

/// A section as it stands in a file, without its checksum.
struct RawSection {
  std::string tag;
  std::string content;
};

/// The sections, without END, of bytes that need not be of a whole file: what does not look like a
/// section ends the list.
[[nodiscard]] inline std::vector<RawSection> split_sections(std::string_view bytes) {
  std::vector<RawSection> sections;
  std::size_t at = kSessionHeadSize;
  while (at < bytes.size() && bytes.size() - at >= kSectionExtraSize) {
    const std::string tag(bytes.substr(at, 4));
    ByteReader head(std::string(bytes.substr(at + 4, 8)), "");
    const auto size = head.number<std::uint64_t>();
    if (size > bytes.size() - at - kSectionExtraSize || tag == kEndTag) break;
    sections.push_back({tag, std::string(bytes.substr(at + kSectionHeadSize, size))});
    at += size + kSectionExtraSize;
  }
  return sections;
}

/// A file of these sections, with right checksums.
[[nodiscard]] inline std::string join_sections(const std::vector<RawSection>& sections) {
  std::string bytes;
  SectionWriter out([&](std::string_view more) { bytes.append(more); });
  for (const RawSection& section : sections) {
    ByteWriter content;
    content.array<char>(std::vector<char>(section.content.begin(), section.content.end()));
    out.write(section.tag, content, "");
  }
  out.finish();
  return bytes;
}

}  // namespace stillmap
