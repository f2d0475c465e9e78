// SPDX-License-Identifier: Apache-2.0
// How soon and how well a camera is relocalised after it was covered for 1 s:
// relocation_table TRIALS NAME[@CAMERA]=SEQUENCE... [stranger.NAME[@CAMERA]=SEQUENCE...]
// The first half of each sequence is mapped; then the camera is covered and continues elsewhere in
// the sequence: at frames of the first half, and at frames of the second half near one of these.
// Where it continues in a stranger, it must stay lost. Prints Markdown.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include <fmt/core.h>
#include <opencv2/core/utility.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include "stillmap/core/error.hpp"
#include "stillmap/core/random.hpp"
#include "stillmap/geometry/se3.hpp"
#include "stillmap/perception/detections/detections_io.hpp"
#include "stillmap/sensor/camera_io.hpp"
#include "stillmap/sensor/sequence.hpp"
#include "tests/relocation_trial.hpp"
#include "tooling/eval/pose_at.hpp"

namespace stillmap {
namespace {

constexpr int kDarkFrames = 30;
constexpr std::size_t kFramesAfter = 30;

struct Place {
  std::string name;
  bool stranger = false;
  Sequence sequence;
  std::optional<DetectionsFolder> detections;
  std::vector<std::optional<Eigen::Isometry3d>> T_truth_camera;  // per frame
};

Place open_place(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) throw Error("{}: expected NAME=FOLDER", text);
  const std::string label = text.substr(0, equals);
  const std::string name = label.substr(0, label.find('@'));
  SequenceOptions options;
  if (name.size() < label.size()) options.camera = builtin_camera(label.substr(name.size() + 1));
  Place place{name, false, Sequence::open(text.substr(equals + 1), options), {}, {}};
  constexpr std::string_view kStranger = "stranger.";
  if (name.starts_with(kStranger)) {
    place.stranger = true;
    place.name = name.substr(kStranger.size());
  }
  const CameraModel& camera = place.sequence.camera();
  const std::filesystem::path found = place.sequence.path() / "detections";
  if (std::filesystem::exists(found)) {
    place.detections = DetectionsFolder::open(found, {camera.width_px, camera.height_px});
  }
  const Trajectory truth = place.sequence.groundtruth().value().poses;
  for (std::uint32_t i = 0; i < place.sequence.size(); ++i) {
    place.T_truth_camera.push_back(pose_at(truth, place.sequence.entry(FrameId(i)).stamp.seconds));
  }
  return place;
}

TrialView view(const Place& place, std::size_t i) {
  TrialView view;
  view.frame = place.sequence.read(FrameId(static_cast<std::uint32_t>(i)));
  if (place.detections) view.detections = place.detections->at(view.frame->stamp);
  view.T_truth_camera = place.T_truth_camera[i].value_or(Eigen::Isometry3d::Identity());
  return view;
}

struct Apart {
  double m = 0;
  double deg = 0;
  [[nodiscard]] double sum() const { return m / 0.3 + deg / 15.0; }
};

Apart apart(const Place& place, std::size_t i, std::size_t j) {
  const Eigen::Isometry3d T = place.T_truth_camera[i]->inverse() * *place.T_truth_camera[j];
  return {T.translation().norm(), rotation_angle(T.linear()) * 180.0 / std::numbers::pi};
}

// The nearest of the frames before `known`.
Apart nearest(const Place& place, std::size_t known, std::size_t i) {
  Apart best{1e9, 1e9};
  for (std::size_t j = 0; j < known; ++j) {
    if (!place.T_truth_camera[j]) continue;
    const Apart here = apart(place, i, j);
    if (here.sum() < best.sum()) best = here;
  }
  return best;
}

// The frames at which to continue: known ones, or later ones that are near a known one.
std::vector<std::size_t> choices(const Place& place, std::size_t known, bool visited) {
  std::vector<std::size_t> frames;
  for (std::size_t i = 0; i + kFramesAfter < place.T_truth_camera.size(); ++i) {
    const auto begin = place.T_truth_camera.begin() + static_cast<std::ptrdiff_t>(i);
    const bool all_known =
        std::all_of(begin, begin + kFramesAfter, [](const auto& pose) { return pose.has_value(); });
    if (!all_known || (i + kFramesAfter <= known) != visited) continue;
    if (!visited && i < known) continue;
    const Apart near = visited ? Apart{} : nearest(place, known, i);
    const Apart jump = apart(place, i, known - 1);
    const bool is_new = near.m > 0.05 || near.deg > 2.5;
    if (near.m <= 0.3 && near.deg <= 15 && (visited || is_new) && jump.sum() > 0.5) {
      frames.push_back(i);
    }
  }
  return frames;
}

// Forks this process here, so that the known part is run only once; returns the text that the copy
// writes to `file`.
TrialOutcome go_on(RelocationTrial& trial, const Place& place, std::size_t jump_to) {
  int pipe_ends[2] = {};
  if (pipe(pipe_ends) != 0) throw Error("no pipe");
  const pid_t child = fork();
  if (child == 0) {
    trial.cover(kDarkFrames);
    for (std::size_t i = 0; i < kFramesAfter; ++i) trial.show(view(place, jump_to + i));
    const TrialOutcome outcome = judge_trial(trial.finish());
    const bool written = write(pipe_ends[1], &outcome, sizeof outcome) == sizeof outcome;
    _exit(written ? 0 : 1);
  }
  close(pipe_ends[1]);
  TrialOutcome outcome;
  const bool read_whole = read(pipe_ends[0], &outcome, sizeof outcome) == sizeof outcome;
  close(pipe_ends[0]);
  waitpid(child, nullptr, 0);
  if (!read_whole) throw Error("a trial ended early");
  return outcome;
}

struct Row {
  int trials = 0, at_first = 0, within_5 = 0, wrong = 0, invented = 0, later = 0, never = 0;
  double largest_later_m = 0;
  std::vector<double> errors_m, errors_deg;

  void add(const TrialOutcome& outcome) {
    ++trials;
    invented += outcome.invented;
    if (outcome.found_at == 0) {
      ++never;
      return;
    }
    if (!outcome.right()) {
      ++wrong;
    } else {
      at_first += outcome.found_at == 1 ? 1 : 0;
      (outcome.found_at <= 5 ? within_5 : later) += 1;
    }
    largest_later_m = std::max(largest_later_m, outcome.largest_error_m);
    errors_m.push_back(outcome.error_m);
    errors_deg.push_back(outcome.error_deg);
  }
};

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values.empty() ? 0 : values[values.size() / 2];
}

double largest(const std::vector<double>& values) {
  return values.empty() ? 0 : *std::ranges::max_element(values);
}

void print_row(const std::string& name, const Row& row) {
  fmt::print("| {} | {} | {} | {} | {} | {} | {} | {} | {:.3f} {:.3f} | {:.2f} {:.2f} | {:.3f} |\n",
             name,
             row.trials,
             row.at_first,
             row.within_5,
             row.later,
             row.never,
             row.wrong,
             row.invented,
             median(row.errors_m),
             largest(row.errors_m),
             median(row.errors_deg),
             largest(row.errors_deg),
             row.largest_later_m);
  std::fflush(stdout);
}

void tell(const std::string& where, std::size_t jump_to, const Apart& near, const TrialOutcome& o) {
  fmt::print(stderr,
             "{} {} ({:.2f} m {:.1f} deg): found at {}, {:.4f} m {:.2f} deg, later {:.4f} m {:.2f} "
             "deg, tracked {} of {}\n",
             where,
             jump_to,
             near.m,
             near.deg,
             o.found_at,
             o.error_m,
             o.error_deg,
             o.largest_error_m,
             o.largest_error_deg,
             o.tracked,
             o.shown);
}

struct Table {
  Row visited, near, strangers;
};

void try_place(const Place& place, const std::vector<Place>& places, int trials, Table& table) {
  const std::size_t known = place.sequence.size() / 2;
  const SystemConfig config;
  RelocationTrial trial(config, place.sequence.camera());
  for (std::size_t i = 0; i < known; ++i) trial.show(view(place, i));
  std::mt19937 rng = rng_for(0, FrameId(0), RandomPurpose::kAbsolutePose);
  for (const bool visited : {true, false}) {
    const std::vector<std::size_t> frames = choices(place, known, visited);
    Row row;
    for (int i = 0; i < trials && !frames.empty(); ++i) {
      const std::size_t jump_to =
          frames[draw_index(rng, static_cast<std::uint32_t>(frames.size()))];
      const TrialOutcome outcome = go_on(trial, place, jump_to);
      tell(place.name, jump_to, nearest(place, known, jump_to), outcome);
      row.add(outcome);
      (visited ? table.visited : table.near).add(outcome);
    }
    print_row(place.name + (visited ? ", a frame of the known part" : ", near the known part"),
              row);
  }
  for (const Place& other : places) {
    const CameraModel &mine = place.sequence.camera(), &its = other.sequence.camera();
    if (!other.stranger || mine.width_px != its.width_px) continue;
    Row row;
    const auto starts = static_cast<std::uint32_t>(other.sequence.size() - kFramesAfter);
    for (int i = 0; i < trials; ++i) {
      const std::size_t jump_to = draw_index(rng, starts);
      const TrialOutcome outcome = go_on(trial, other, jump_to);
      if (outcome.found_at > 0) tell(place.name + " in " + other.name, jump_to, {}, outcome);
      row.add(outcome);
      table.strangers.add(outcome);
    }
    print_row(place.name + ", goes on in " + other.name, row);
  }
}

int run(const std::vector<std::string>& arguments) {
  cv::setNumThreads(0);  // a copy of the process has no other threads
  const int trials = std::stoi(arguments.at(0));
  std::vector<Place> places;
  for (std::size_t i = 1; i < arguments.size(); ++i) places.push_back(open_place(arguments[i]));
  fmt::print(
      "| trials | number | found in the first frame | within 5 | later | never | wrong | poses in "
      "the dark | error m: median, largest | degrees | largest m in the second after |\n");
  fmt::print("|---|---|---|---|---|---|---|---|---|---|---|\n");
  std::fflush(stdout);
  Table table;
  for (const Place& place : places) {
    if (!place.stranger) try_place(place, places, trials, table);
  }
  print_row("all, a frame of the known part", table.visited);
  print_row("all, near the known part", table.near);
  print_row("all, elsewhere", table.strangers);
  return 0;
}

}  // namespace
}  // namespace stillmap

int main(int argc, char** argv) {
  try {
    return stillmap::run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    fmt::print(stderr, "relocation_table: {}\n", error.what());
    return 2;
  }
}
