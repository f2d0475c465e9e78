// SPDX-License-Identifier: Apache-2.0
// The commands of the program inside Python. apps/commands has them; how a command speaks to its
// user, declared in apps/, is defined here once more, for Python.
#include "apps/commands.hpp"

#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/core.h>
#include <opencv2/core/utility.hpp>
#include <pybind11/stl.h>

#include "apps/command_line.hpp"
#include "apps/interruption.hpp"
#include "apps/progress_bar.hpp"
#include "python/bindings/bindings.hpp"
#include "stillmap/core/error.hpp"

namespace py = pybind11;

namespace stillmap {
namespace {

constexpr const char* kRunCommandDoc =
    R"(Runs a command of the program (run, segment, synth) with the arguments of its command line.

Returns its exit code: 0, or 3 where tracking was lost for good. The functions of the package are
easier to call.)";

py::object stream(const char* name) {
  return py::module_::import("sys").attr(name);
}

// What cannot be shown must not end a command; Ctrl-C meanwhile must.
void show_on_terminal(const std::string& text) {
  const py::gil_scoped_acquire acquire;
  try {
    stream("stderr").attr("write")(text);
  } catch (py::error_already_set& failure) {
    if (failure.matches(PyExc_KeyboardInterrupt)) PyErr_SetInterrupt();
  }
}

// Ctrl-C ends a command between two frames.
void end_if_interrupted() {
  const py::gil_scoped_acquire acquire;
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

// OpenCV's own threads would compete with the library's. The process has them back afterwards.
class WithoutThreadsOfOpenCv {
 public:
  WithoutThreadsOfOpenCv() : before_(cv::getNumThreads()) { cv::setNumThreads(1); }
  ~WithoutThreadsOfOpenCv() { cv::setNumThreads(before_); }
  WithoutThreadsOfOpenCv(const WithoutThreadsOfOpenCv&) = delete;
  WithoutThreadsOfOpenCv& operator=(const WithoutThreadsOfOpenCv&) = delete;

 private:
  int before_;
};

int run_command(const std::vector<std::string>& arguments) {
  const py::gil_scoped_release release;
  const WithoutThreadsOfOpenCv without;
  CommandResult result;
  CLI::App app("stillmap in Python", "stillmap");
  app.require_subcommand(1);
  add_run_command(app, result);
  add_segment_command(app, result);
  add_synth_command(app, result);
  run_command_line(app, arguments);
  return result.exit_code;
}

}  // namespace

void print_output(std::string_view text) {
  const py::gil_scoped_acquire acquire;
  const py::object out = stream("stdout");
  if (!out.is_none()) out.attr("write")(py::str(text.data(), text.size()));
}

ProgressBar::ProgressBar(std::string unit) : unit_(std::move(unit)) {
  const py::gil_scoped_acquire acquire;
  const py::object err = stream("stderr");
  on_terminal_ = !err.is_none() && py::cast<bool>(err.attr("isatty")());
}

ProgressBar::~ProgressBar() {
  finish();
}

void ProgressBar::show(std::size_t done, std::size_t total) {
  end_if_interrupted();
  const int percent = total > 0 ? static_cast<int>(100 * done / total) : shown_percent_;
  if (!on_terminal_ || percent == shown_percent_) return;
  shown_percent_ = percent;
  show_on_terminal(fmt::format("\r{:>3} %  {}/{} {}", percent, done, total, unit_));
}

void ProgressBar::say(const std::string& line) const {
  if (on_terminal_) show_on_terminal(line + "\n");
}

void ProgressBar::warn(const std::string& warning) {
  const py::gil_scoped_acquire acquire;
  if (PyErr_WarnEx(PyExc_UserWarning, warning.c_str(), 1) != 0) throw py::error_already_set();
}

void ProgressBar::finish() {
  if (shown_percent_ < 0) return;
  shown_percent_ = -1;
  show_on_terminal("\n");
}

// Python has handlers of its own: ProgressBar::show() asks them.
void note_interruption() {}

void note_no_interruption() {}

bool interruption_noted() {
  return false;
}

namespace python {

void add_commands(py::module_& module) {
  module.def("run_command",
             &run_command,
             py::arg("arguments"),
             doc("run_command(arguments)", kRunCommandDoc).c_str());
}

}  // namespace python
}  // namespace stillmap
