// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

namespace stillmap {

/// The files and folders that a command reads. No output of the command may replace any of them.
class InputFiles {
 public:
  /// Adds a file, or a folder with all that is in it, whether it exists or not: a file that a
  /// command would read if it existed must not come into being as its output.
  void add(const std::filesystem::path& input);

  /// To be called before the command begins to work, for each file that it is going to write, and
  /// for each folder of which it replaces all files. Throws Error, beginning with the option that
  /// names the output, where `output` is an input, lies in one or has one in it, by any path.
  void check_output(std::string_view option, const std::filesystem::path& output) const;

 private:
  struct Place {
    std::filesystem::path given;
    std::filesystem::path canonical;
  };
  std::vector<Place> inputs_;
};

}  // namespace stillmap
