// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <fmt/core.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "python/bindings/bindings.hpp"
#include "python/bindings/values.hpp"
#include "stillmap/core/error.hpp"
#include "stillmap/session/merge_sessions.hpp"
#include "stillmap/session/session_cloud.hpp"
#include "stillmap/session/session_io.hpp"
#include "stillmap/session/session_map.hpp"

namespace stillmap::python {

namespace py = pybind11;

namespace {

constexpr const char* kSessionDoc = R"(A saved run: the file map.stillmap.

    monday = Session.load("monday/map.stillmap")
    room = monday.merged(Session.load("tuesday/map.stillmap"))
    if room is not None: room.save("room.stillmap"))";

struct SavedSession {
  Session session;
  std::string name;  // for messages
};

SavedSession load_session(const std::filesystem::path& file) {
  return {read_session(file), file.string()};
}

std::optional<SavedSession> merged(const SavedSession& first, const SavedSession& second) {
  std::optional<MergedSessions> result = merge_sessions(first.session, second.session, second.name);
  if (!result) return std::nullopt;
  return SavedSession{std::move(result->session), first.name + " + " + second.name};
}

}  // namespace

void add_sessions(py::module_& module) {
  using Release = py::call_guard<py::gil_scoped_release>;
  py::class_<SavedSession>(module, "Session", kSessionDoc)
      .def_static("load",
                  &load_session,
                  py::arg("file"),
                  Release(),
                  doc("load(file)", "Reads a map.stillmap, which need not be trusted.").c_str())
      .def(
          "save",
          [](const SavedSession& self, const std::filesystem::path& file) {
            write_session(file, self.session);
          },
          py::arg("file"),
          Release(),
          doc("save(self, file)", "Writes a map.stillmap.").c_str())
      .def("merged",
           &merged,
           py::arg("other"),
           Release(),
           doc("merged(self, other)",
               "Both in one, in this session's coordinates, by the places that they have in\n"
               "common; None where no such place is recognised.")
               .c_str())
      .def(
          "map",
          [](const SavedSession& self) {
            return session_cloud(self.session, main_submap(self.session), self.name);
          },
          Release(),
          doc("map(self)", "The dense map.").c_str())
      .def_property_readonly(
          "trajectory",
          [](const SavedSession& self) {
            return Poses{trajectory_in(self.session, main_submap(self.session))};
          },
          "The poses of the tracked frames.")
      .def_property_readonly(
          "keyframes",
          [](const SavedSession& self) {
            return Poses{keyframes_in(self.session, main_submap(self.session))};
          },
          "The poses of the key frames.")
      .def_property_readonly(
          "camera", [](const SavedSession& self) { return self.session.camera; }, "Its Camera.")
      .def("__repr__", [](const SavedSession& self) {
        return fmt::format("<stillmap.Session {}>", self.name);
      });
}

}  // namespace stillmap::python
