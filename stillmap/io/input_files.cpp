// SPDX-License-Identifier: Apache-2.0
#include "stillmap/io/input_files.hpp"

#include <algorithm>
#include <system_error>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;

// The canonical form of a path, whether it exists or not.
fs::path canonical_form(const fs::path& path) {
  std::error_code failure;
  fs::path canonical = fs::weakly_canonical(fs::absolute(path, failure), failure);
  if (failure) canonical = fs::absolute(path, failure).lexically_normal();
  return canonical.has_filename() ? canonical : canonical.parent_path();
}

bool is_in(const fs::path& path, const fs::path& folder) {
  return std::ranges::mismatch(folder, path).in1 == folder.end();
}

// Also by other names of the file (hard links).
bool is_same_file(const fs::path& a, const fs::path& b) {
  std::error_code ignored;
  return fs::equivalent(a, b, ignored);
}

}  // namespace

void InputFiles::add(const fs::path& input) {
  if (!input.empty()) inputs_.push_back({input, canonical_form(input)});
}

void InputFiles::check_output(std::string_view option, const fs::path& output) const {
  const fs::path canonical = canonical_form(output);
  for (const Place& input : inputs_) {
    if (!is_in(canonical, input.canonical) && !is_in(input.canonical, canonical) &&
        !is_same_file(canonical, input.canonical)) {
      continue;
    }
    throw Error("{} {}: this is the input {}, which would be overwritten; name another place",
                option,
                output.string(),
                input.given.string());
  }
}

}  // namespace stillmap
