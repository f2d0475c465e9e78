// SPDX-License-Identifier: Apache-2.0
#if STILLMAP_WITH_VIEWER
#include "tooling/view/page_files.hpp"

#include <algorithm>
#include <array>

#include "tooling/browser/scripts.hpp"

namespace stillmap {
namespace {

using Text = std::string_view (*)();

struct NamedFile {
  std::string_view name;
  Text text;
  std::string_view type;
};
constexpr std::string_view kScript = "text/javascript; charset=utf-8";
constexpr std::array<NamedFile, 19> kFiles = {
    {{"", index_html, "text/html; charset=utf-8"},
     {"viewer.css", viewer_css, "text/css; charset=utf-8"},
     {"three.min.js", three_min_js, kScript},
     {"OrbitControls.js", OrbitControls_js, kScript},
     {"cameras.js", cameras_js, kScript},
     {"keys.js", keys_js, kScript},
     {"labels.js", labels_js, kScript},
     {"main.js", main_js, kScript},
     {"message.js", message_js, kScript},
     {"objects.js", objects_js, kScript},
     {"panel.js", panel_js, kScript},
     {"picture.js", picture_js, kScript},
     {"points.js", points_js, kScript},
     {"records.js", records_js, kScript},
     {"run_scene.js", run_scene_js, kScript},
     {"scene.js", scene_js, kScript},
     {"scrubber.js", scrubber_js, kScript},
     {"shading.js", shading_js, kScript},
     {"socket.js", socket_js, kScript}}};

}  // namespace

std::optional<PageFile> page_file(std::string_view name) {
  const auto found = std::ranges::find(kFiles, name, &NamedFile::name);
  if (found == kFiles.end()) return std::nullopt;
  return PageFile{found->text(), found->type};
}

}  // namespace stillmap
#endif
