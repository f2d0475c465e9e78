// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <vector>

#include <fmt/core.h>

#include "tooling/browser/scripts.hpp"
#include "tooling/report/display_text.hpp"
#include "tooling/report/map_message.hpp"
#include "tooling/report/map_picture.hpp"
#include "tooling/report/map_views.hpp"
#include "tooling/report/page_assets.hpp"
#include "tooling/report/page_sections.hpp"
#include "tooling/report/picture_html.hpp"
#include "tooling/report/scene_frame.hpp"

namespace stillmap {
namespace {

std::string map_figures(const RunReport& report, const SceneFrame& scene) {
  constexpr Rgb kPathColor = {225, 107, 0};
  struct Figure {
    MapSide side;
    const char* caption;
  };
  const PointCloud map = cut_open(*report.map, scene);
  std::string out;
  for (const Figure& figure : {Figure{MapSide::kFront, "From the front"},
                               Figure{MapSide::kLeft, "From the left"},
                               Figure{MapSide::kTop, "From above"}}) {
    const View view = view_from(figure.side, scene, map, {640, 480});
    ColorImage picture = render_smooth(map, view);
    for (const std::vector<Eigen::Vector3d>& part : continuous_parts(report.estimate)) {
      picture = draw_path(picture, view, part, kPathColor);
    }
    out += figure_html(picture, "The map, " + std::string(figure.caption), figure.caption);
  }
  return "<div class=\"views\">" + out + "</div>";
}

const char* const kViewHtml = R"(<figure id="map-view" hidden>
<div class="scene" data-tool="scene" aria-label="The map, the camera and objects in three dimensions"></div>
<div class="tools" data-tool="frames">
<button type="button" data-tool="play" aria-label="Play">&#9654;</button>
<input type="range" data-tool="scrubber" min="0" max="0" value="0" aria-label="Frame">
<output data-tool="time"></output>
</div>
<div class="tools">
<button type="button" data-tool="whole">Whole</button>
<button type="button" data-tool="above">From above</button>
<label><input type="checkbox" data-tool="path" checked>path</label>
<label><input type="checkbox" data-tool="keyframes" checked>key frames</label>
<label><input type="checkbox" data-tool="objects" checked>objects</label>
<label><input type="checkbox" data-tool="ceiling" checked>ceiling</label>
<label>point size <input type="range" data-tool="size" min="-2" max="2" step="0.1" value="0"></label>
<span class="note">Drag to turn, right button or two fingers to move, click and wheel or pinch to zoom.</span>
</div>
</figure>
<p id="map-note" class="note">)";

std::string view_html() {
  const char* const note =
      three_min_js().empty()
          ? "The program was built without libjs-three, with which the map can be turned; here are "
            "pictures of it."
          : "The view that can be turned needs JavaScript and WebGL; here are pictures of the map.";
  return fmt::format("{}{}</p>\n", kViewHtml, note);
}

std::string view_scripts(const RunReport& report, const SceneFrame& scene) {
  if (three_min_js().empty()) return "";
  return fmt::format(
      "<script type=\"text/plain\" id=\"map-data\">{}</script>\n<script>\n{}</script>\n"
      "<script>\n{}</script>\n<script>\n{}</script>",
      map_message(report, scene),
      three_min_js(),
      OrbitControls_js(),
      map_scripts_js());
}

}  // namespace

MapHtml map_html(const RunReport& report) {
  if (report.map == nullptr) return {"<p>No map was made.</p>", ""};
  const SceneFrame scene = scene_frame(*report.map, report.estimate);
  if (scene.box.isEmpty()) return {"<p>The map is empty.</p>", ""};
  const Eigen::Vector3d size = scene.box.sizes();
  const std::string summary = fmt::format(
      "<p class=\"note\">{} points, about {:.1f} \u00D7 {:.1f} \u00D7 {:.1f} m (width, height, "
      "depth). "
      "{}The camera's path is drawn over the map; the pictures "
      "leave out what hangs over the camera.</p>",
      count_text(report.map->size()),
      size.x(),
      size.y(),
      size.z(),
      report.map->size() > kMapMessagePoints
          ? fmt::format("Shown are {} of them. ", count_text(kMapMessagePoints))
          : "");
  return {.section = summary + view_html() + map_figures(report, scene) + map_quality_html(report),
          .script = view_scripts(report, scene)};
}

}  // namespace stillmap
