// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "apps/commands.hpp"
#include "stillmap/core/error.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "stillmap/io/folder_replacement.hpp"
#include "stillmap/io/input_files.hpp"
#include "stillmap/session/merge_tree.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;

struct MergeArguments {
  std::vector<std::string> sessions;
  std::string out;
  std::string parts;
};

constexpr std::string_view kListOfParts = "parts.json";

// A new folder for merged maps on the way, removed at the end.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = (fs::temp_directory_path() / "stillmap-merge-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) {
      throw Error("{}: no folder can be made there ({}); $TMPDIR names another place",
                  fs::temp_directory_path().string(),
                  std::generic_category().message(errno));
    }
    path_ = name;
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

template <class Sink>
void copy_bytes(const fs::path& file, const Sink& sink) {
  std::ifstream in(file, std::ios::binary);
  std::array<char, 1 << 16> buffer;
  while (in.read(buffer.data(), buffer.size()) || in.gcount() > 0) {
    sink(std::string_view(buffer.data(), static_cast<std::size_t>(in.gcount())));
  }
  if (!in.eof()) throw Error("{}: cannot be read to its end", file.string());
}

std::string counted(std::size_t number, const char* thing) {
  return fmt::format("{} {}{}", number, thing, number == 1 ? "" : "s");
}

std::string line_of(const MergedPart& part, const std::string& place) {
  if (part.sessions.size() == 1) {
    return fmt::format(
        "apart       {} ({})\n", part.sessions.front(), counted(part.keyframes, "key frame"));
  }
  return fmt::format("merged      {}, {} by {}\nwritten     {}\n",
                     counted(part.sessions.size(), "session"),
                     counted(part.keyframes, "key frame"),
                     counted(part.loops, "loop"),
                     place);
}

// Of a map that is not the largest.
std::string line_of_unwritten(const MergedPart& part) {
  if (part.sessions.size() == 1) return line_of(part, "");
  std::string text = "apart      ";
  for (const std::string& session : part.sessions) text += " " + session;
  return text + " (one map; --parts writes it)\n";
}

void write_largest(const std::vector<MergedPart>& parts, const MergeArguments& arguments) {
  const auto largest =
      std::ranges::find_if(parts, [](const MergedPart& part) { return part.sessions.size() > 1; });
  if (largest == parts.end()) {
    throw Error(
        "{} and {}: no place of one is recognised in the other; nothing was written. Sessions of "
        "one room need views of the same things from about the same side",
        arguments.sessions.front(),
        arguments.sessions.size() == 2 ? arguments.sessions.back()
                                       : counted(arguments.sessions.size() - 1, "more session"));
  }
  AtomicFile file(arguments.out);
  copy_bytes(largest->file, [&](std::string_view bytes) { file.write(bytes); });
  file.close();
  file.take_place();
  std::string text = line_of(*largest, arguments.out);
  for (auto part = parts.begin(); part != parts.end(); ++part) {
    if (part != largest) text += line_of_unwritten(*part);
  }
  print_output(text);
}

std::string file_of_part(std::size_t index) {
  return fmt::format("{}.stillmap", index + 1);
}

bool is_of_parts(const fs::path& name) {
  return name == kListOfParts || name.extension() == ".stillmap";
}

void write_all(const std::vector<MergedPart>& parts, const MergeArguments& arguments) {
  FolderReplacement folder(arguments.parts, is_of_parts);
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  std::string text;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::string name = file_of_part(i);
    folder.write(name,
                 [&](const FolderReplacement::Sink& sink) { copy_bytes(parts[i].file, sink); });
    list.push_back({{"file", name},
                    {"keyframes", parts[i].keyframes},
                    {"loops", parts[i].loops},
                    {"sessions", parts[i].sessions}});
    text += line_of(parts[i], (fs::path(arguments.parts) / name).string());
  }
  folder.write(kListOfParts, list.dump(1) + "\n");
  folder.take_place();
  print_output(text);
}

void run_merge(const MergeArguments& arguments) {
  if (arguments.out.empty() == arguments.parts.empty()) {
    throw Error("merge: expected --out FILE or --parts FOLDER");
  }
  InputFiles inputs;
  for (const std::string& session : arguments.sessions) inputs.add(session);
  if (arguments.out.empty()) {
    inputs.check_output("--parts", arguments.parts);
  } else {
    inputs.check_output("--out", arguments.out);
  }
  const ScratchFolder scratch;
  const std::vector<MergedPart> parts =
      merge_as_tree({arguments.sessions.begin(), arguments.sessions.end()}, scratch.path());
  arguments.out.empty() ? write_all(parts, arguments) : write_largest(parts, arguments);
}

}  // namespace

void add_merge_command(CLI::App& app, CommandResult& /*result*/) {
  CLI::App* command =
      app.add_subcommand("merge", "Merge saved sessions of one room by common places");
  const auto arguments = std::make_shared<MergeArguments>();
  command
      ->add_option("SESSIONS",
                   arguments->sessions,
                   "two or more map.stillmap of one camera, in any order; the coordinates of the "
                   "earliest are kept")
      ->required()
      ->expected(-2);  // 2 or more
  command->add_option("--out", arguments->out, "file for the largest map that they make");
  command->add_option("--parts",
                      arguments->parts,
                      "folder for all maps that they make, also of those that have no place in "
                      "common with others, and parts.json, which says what is in which");
  command->footer(
      "Examples:\n"
      "  stillmap merge monday/map.stillmap tuesday/map.stillmap --out office.stillmap\n"
      "  stillmap merge visits/*/map.stillmap --parts building\n"
      "  stillmap export office.stillmap --ply office.ply");
  command->callback([arguments] { run_merge(*arguments); });
}

}  // namespace stillmap
