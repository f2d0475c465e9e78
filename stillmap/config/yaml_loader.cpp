// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cerrno>
#include <fstream>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/core.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include "stillmap/config/config_io.hpp"
#include "stillmap/config/field_keys.hpp"
#include "stillmap/config/field_text.hpp"
#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

constexpr std::size_t kMaxBytes = 1U << 20U;

// Reads at most one byte more than is allowed.
std::string read_capped(const std::filesystem::path& file) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) {
    throw Error("{}: a folder, expected a YAML file", file.string());
  }
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream)
    throw Error("{}: cannot be opened: {}", file.string(), std::generic_category().message(errno));
  std::string bytes(kMaxBytes + 1, '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (stream.bad())
    throw Error("{}: cannot be read: {}", file.string(), std::generic_category().message(errno));
  bytes.resize(static_cast<std::size_t>(stream.gcount()));
  return bytes;
}

[[noreturn]] void fail_at(const std::string& file, std::string_view before, std::string_view text) {
  throw Error("{}:{}: {}", file, 1 + std::ranges::count(before, '\n'), text);
}

// Refuses input that the parser would silently accept: bytes that are no text, and directives.
void check_text(const std::string& file, std::string_view text) {
  const std::size_t good = text_prefix(text);
  if (good != text.size()) {
    const auto byte = static_cast<unsigned char>(text[good]);
    fail_at(file,
            text.substr(0, good),
            fmt::format("byte 0x{:02x} is not UTF-8 text, expected a YAML file", byte));
  }
  const std::size_t line_before = text.find("\n%");
  if (text.starts_with('%') || line_before != std::string_view::npos) {
    const std::size_t at = text.starts_with('%') ? 0 : line_before + 1;
    fail_at(file, text.substr(0, at), "directives ('%' lines) are not supported");
  }
}

// The parser detects an unclosed quote only when no line end follows.
std::string without_end_space(std::string text) {
  text.erase(text.find_last_not_of(" \t\r\n") + 1);
  return text;
}

// Sets fields during parsing. Events, unlike yaml-cpp's nodes, have every line number, show
// repeated keys, and end hostile input at its first unsupported construct.
class FieldSetter final : public YAML::EventHandler {
 public:
  FieldSetter(std::span<const FieldRef> fields, std::string file, UnknownKeys unknown)
      : fields_(fields), file_(std::move(file)), unknown_(unknown) {}

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (started_) fail(mark, "expected one YAML document, this is a second one");
    started_ = true;
  }
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    if (skipped()) return;
    check_plain(mark, "", anchor);
    if (groups_.empty()) fail(mark, kExpectedMap);
    if (!key_) fail(mark, "expected a key, got nothing");
    // A group whose keys are all commented out is null in YAML.
    if (find_group(fields_, *key_) == nullptr) fail_value(key_mark_, "nothing");
    key_.reset();
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t /*anchor*/) override {
    fail(mark, "aliases are not supported, write the value out");
  }

  void OnScalar(const YAML::Mark& mark,
                const std::string& tag,
                YAML::anchor_t anchor,
                const std::string& value) override {
    if (skipped()) return;
    check_plain(mark, tag, anchor);
    if (groups_.empty()) fail(mark, kExpectedMap);
    if (!key_) return take_key(mark, value);
    const FieldRef* field = find_field(fields_, *key_);
    if (field == nullptr) throw_is_group(*find_group(fields_, *key_), *key_, where(mark));
    assign(*field, value, tag == "!" ? Quoting::kQuoted : Quoting::kPlain, where(mark));
    key_.reset();
  }

  void OnSequenceStart(const YAML::Mark& mark,
                       const std::string& /*tag*/,
                       YAML::anchor_t /*anchor*/,
                       YAML::EmitterStyle::value /*style*/) override {
    if (begins_skipped()) return;
    fail_construct(mark, "a list");
  }
  void OnSequenceEnd() override { (void)ends_skipped(); }

  void OnMapStart(const YAML::Mark& mark,
                  const std::string& tag,
                  YAML::anchor_t anchor,
                  YAML::EmitterStyle::value /*style*/) override {
    if (begins_skipped()) return;
    check_plain(mark, tag, anchor);
    const bool is_group = key_ && find_group(fields_, *key_) != nullptr;
    if (!groups_.empty() && !is_group) fail_construct(mark, "a map");
    groups_.push_back(key_.value_or(""));
    key_.reset();
  }
  void OnMapEnd() override {
    if (!ends_skipped()) groups_.pop_back();
  }

 private:
  static constexpr const char* kExpectedMap = "expected a map of keys ('key: value' lines)";

  // Whether a value belongs to a key that is skipped.
  bool skipped() {
    if (!skipping_) return false;
    if (*skipping_ == 0) skipping_.reset();
    return true;
  }
  bool begins_skipped() {
    if (skipping_) ++*skipping_;
    return skipping_.has_value();
  }
  bool ends_skipped() {
    if (!skipping_) return false;
    if (--*skipping_ == 0) skipping_.reset();
    return true;
  }

  [[nodiscard]] std::string where(const YAML::Mark& mark) const {
    return fmt::format("{}:{}", file_, mark.line + 1);
  }

  [[noreturn]] void fail(const YAML::Mark& mark, std::string_view text) const {
    throw Error("{}: {}", where(mark), text);
  }

  [[noreturn]] void fail_value(const YAML::Mark& mark, std::string_view got) const {
    const FieldRef* field = find_field(fields_, *key_);
    fail(mark, fmt::format("{}: expected {}, got {}", *key_, expectation(*field), got));
  }

  // A list or a map in the wrong place.
  [[noreturn]] void fail_construct(const YAML::Mark& mark, std::string_view got) const {
    if (groups_.empty()) fail(mark, fmt::format("{}, got {}", kExpectedMap, got));
    if (!key_) fail(mark, fmt::format("expected a key, got {}", got));
    if (find_field(fields_, *key_) != nullptr) fail_value(mark, got);
    fail(mark, fmt::format("{}: expected a map of keys, got {}", *key_, got));
  }

  // "" and "?" mark bare text, "!" text in quotes; anything else is a tag written out.
  void check_plain(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor) const {
    if (anchor != YAML::NullAnchor) fail(mark, "anchors are not supported, write the value out");
    if (!tag.empty() && tag != "?" && tag != "!") {
      fail(mark, fmt::format("tags such as '{}' are not supported", printable(tag)));
    }
  }

  void take_key(const YAML::Mark& mark, const std::string& name) {
    const std::string key = groups_.back().empty() ? name : groups_.back() + "." + name;
    if (find_field(fields_, key) == nullptr && find_group(fields_, key) == nullptr) {
      if (unknown_ == UnknownKeys::kRefuse) throw_unknown_key(fields_, key, where(mark));
      skipping_ = 0;
      return;
    }
    if (!seen_.insert(key).second) fail(mark, fmt::format("{}: repeated key", key));
    key_ = key;
    key_mark_ = mark;
  }

  std::span<const FieldRef> fields_;
  std::string file_;
  std::vector<std::string> groups_;  // the open maps from the outermost, ""
  std::optional<std::string> key_;   // the key that was read; its value is next
  YAML::Mark key_mark_;              // for values without a position of their own
  std::set<std::string> seen_;
  bool started_ = false;
  UnknownKeys unknown_;
  std::optional<int> skipping_;  // the depth of the value of a skipped key; 0 before it
};

}  // namespace

void load_yaml_text(std::span<const FieldRef> fields,
                    std::string_view text,
                    const std::string& name,
                    UnknownKeys unknown) {
  if (text.size() > kMaxBytes) throw Error("{}: larger than 1 MiB, not a configuration", name);
  const std::string yaml = without_end_space(std::string(text));
  if (yaml.empty()) throw Error("{}: empty, expected a YAML file", name);
  check_text(name, yaml);
  std::istringstream stream(yaml);
  FieldSetter setter(fields, name, unknown);
  try {
    YAML::Parser parser(stream);
    while (parser.HandleNextDocument(setter)) {
    }
  } catch (const YAML::Exception& error) {
    throw Error("{}:{}: not valid YAML: {}", name, error.mark.line + 1, error.msg);
  }
}

void load_yaml(std::span<const FieldRef> fields, const std::filesystem::path& file) {
  load_yaml_text(fields, read_capped(file), file.string());
}

}  // namespace stillmap
