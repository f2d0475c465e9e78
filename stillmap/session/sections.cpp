// SPDX-License-Identifier: Apache-2.0
#include "stillmap/session/sections.hpp"

#include <algorithm>

#include <zlib.h>

namespace stillmap {
namespace {

// The printable part of a tag, for messages.
std::string readable(std::string_view bytes) {
  std::string text(bytes);
  for (char& c : text) {
    if (c < ' ' || c > '~') c = '?';
  }
  return text;
}

void check_head(const ByteSource& source, const std::string& file) {
  const std::string head = source.read(
      0, static_cast<std::size_t>(std::min<std::uint64_t>(source.size, kSessionHeadSize)));
  const std::size_t compared = std::min(head.size(), kSessionMagic.size());
  if (head.empty() || head.substr(0, compared) != kSessionMagic.substr(0, compared)) {
    throw Error("{}: not a stillmap session: expected the map.stillmap of a `stillmap run`", file);
  }
  if (head.size() < kSessionHeadSize) {
    throw Error("{}: truncated: it ends at byte {}, within its head", file, head.size());
  }
  ByteReader reader(head.substr(kSessionMagic.size()), file);
  const auto version = reader.number<std::uint32_t>();
  if (reader.number<std::uint32_t>() != checksum(head.substr(0, kSessionHeadSize - 4))) {
    throw Error("{}: damaged: the checksum of its head is wrong; take another copy", file);
  }
  if (version > kSessionVersion) {
    throw Error(
        "{}: written by a newer stillmap (format {}; this one reads {}): install that version or a "
        "later one",
        file,
        version,
        kSessionVersion);
  }
  if (version == 0) throw Error("{}: of format 0, which there never was", file);
  if (version < kOldestSessionVersion) {
    throw Error(
        "{}: written by an older stillmap (format {}; this one reads {}): make it again by a run "
        "with this version",
        file,
        version,
        kSessionVersion);
  }
}

}  // namespace

std::uint32_t checksum(std::string_view bytes, std::uint32_t before) {
  return static_cast<std::uint32_t>(
      ::crc32_z(before, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

std::string session_head(std::uint32_t version) {
  ByteWriter rest;
  rest.number(version);
  const std::string head = std::string(kSessionMagic) + rest.bytes();
  ByteWriter sum;
  sum.number(checksum(head));
  return head + sum.bytes();
}

SectionWriter::SectionWriter(Sink sink, std::uint32_t version) : sink_(std::move(sink)) {
  sink_(session_head(version));
}

void SectionWriter::write(std::string_view tag,
                          const ByteWriter& content,
                          const std::string& place) {
  if (content.bytes().size() > kMaxSectionSize) {
    throw Error("{}: a part ({}) of {} bytes is more than fits into the format",
                place,
                tag,
                content.bytes().size());
  }
  put(tag, content.bytes());
  ++sections_;
}

void SectionWriter::finish() {
  ByteWriter content;
  content.number(sections_);
  put(kEndTag, content.bytes());
}

void SectionWriter::put(std::string_view tag, std::string_view content) {
  STILLMAP_CHECK(tag.size() == 4);
  ByteWriter size, sum;
  size.number(static_cast<std::uint64_t>(content.size()));
  const std::string head = std::string(tag) + size.bytes();
  sum.number(checksum(content, checksum(head)));
  sink_(head);
  sink_(content);
  sink_(sum.bytes());
}

SectionReader::SectionReader(ByteSource source, std::string file)
    : source_(std::move(source)), file_(std::move(file)) {
  check_head(source_, file_);
  read_head();
}

ByteReader SectionReader::read(std::string_view tag) {
  expect(tag);
  std::string content = source_.read(at_ + kSectionHeadSize, next_.size + 4);
  ByteReader sum(content.substr(next_.size), file_);
  content.resize(next_.size);
  if (sum.number<std::uint32_t>() != checksum(content, checksum(next_.bytes))) {
    throw Error("{}: damaged: the checksum is wrong; take another copy", place());
  }
  ByteReader reader(std::move(content), place());
  skip(tag);
  return reader;
}

void SectionReader::skip(std::string_view tag) {
  expect(tag);
  at_ += next_.size + kSectionExtraSize;
  ++sections_;
  if (tag != kEndTag) read_head();
}

void SectionReader::finish() {
  const std::uint32_t before = sections_;
  ByteReader content = read(kEndTag);
  if (content.number<std::uint32_t>() != before) {
    throw Error("{}: damaged: parts of it are missing; take another copy", file_);
  }
  content.finish();
  if (at_ != source_.size) {
    throw Error("{}: damaged: {} bytes behind its end", file_, source_.size - at_);
  }
}

void SectionReader::read_head() {
  if (source_.size - at_ < kSectionExtraSize) throw truncated();
  next_.bytes = source_.read(at_, kSectionHeadSize);
  next_.tag = next_.bytes.substr(0, 4);
  ByteReader reader(next_.bytes.substr(4), file_);
  const auto size = reader.number<std::uint64_t>();
  if (size > source_.size - at_ - kSectionExtraSize) throw truncated();
  if (size > kMaxSectionSize) throw Error("{}: damaged: {} bytes long", place(), size);
  next_.size = static_cast<std::size_t>(size);
}

void SectionReader::expect(std::string_view tag) const {
  if (next_.tag != tag) {
    throw Error("{}: damaged: expected the part {} here", place(), readable(tag));
  }
}

std::string SectionReader::place() const {
  return fmt::format("{}: part {} at byte {}", file_, readable(next_.tag), at_);
}

Error SectionReader::truncated() const {
  return Error(
      "{}: truncated or damaged: it has {} bytes, the part at byte {} needs more; take another "
      "copy",
      file_,
      source_.size,
      at_);
}

}  // namespace stillmap
