// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "stillmap/session/sections.hpp"

namespace stillmap {

/// A section as in a file, without its checksum.
struct RawSection {
  std::string tag;
  std::string content;
};

/// The sections, without END, of the bytes of a file that may be incomplete: the list ends where no
/// valid section follows.
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
  // The version of sessions whose camera it can describe.
  SectionWriter out([&](std::string_view more) { bytes.append(more); }, kOldestSessionVersion);
  for (const RawSection& section : sections) {
    ByteWriter content;
    content.array<char>(std::vector<char>(section.content.begin(), section.content.end()));
    out.write(section.tag, content, "");
  }
  out.finish();
  return bytes;
}

}  // namespace stillmap
