// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include <fmt/core.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "python/bindings/arrays.hpp"
#include "python/bindings/bindings.hpp"
#include "python/bindings/objects.hpp"
#include "python/bindings/values.hpp"
#include "stillmap/core/error.hpp"
#include "stillmap/perception/detections/detections_io.hpp"
#include "stillmap/sensor/open_sequence.hpp"

namespace stillmap::python {

namespace py = pybind11;

namespace {

constexpr const char* kSequenceDoc = R"(The frames of a recorded sequence.

    for frame in Sequence("office"):
        slam.process(frame.color, frame.depth, frame.stamp_text)

`camera` replaces the one that the sequence tells. Frames whose images are damaged are left out,
with a warning.)";

// Each iteration reads the sequence from its beginning.
struct SequenceFolder {
  std::filesystem::path folder;
  std::optional<CameraModel> chosen;
  CameraModel camera;
  std::optional<std::size_t> frames;

  [[nodiscard]] std::unique_ptr<FrameStream> open() const { return open_sequence(folder, chosen); }
};

SequenceFolder open_folder(const std::filesystem::path& folder, const py::object& camera) {
  SequenceFolder sequence{folder, optional_camera_of(camera), {}, {}};
  const std::unique_ptr<FrameStream> stream = sequence.open();
  sequence.camera = stream->camera();
  sequence.frames = stream->size();
  return sequence;
}

// Not const, as pybind11 wants it; no function changes it.
std::shared_ptr<RgbdFrame> next_frame(FrameStream& stream) {
  while (true) {
    std::optional<StreamedFrame> next;
    {
      const py::gil_scoped_release release;
      next = stream.next();
    }
    if (!next) throw py::stop_iteration();
    if (const FramePtr* const frame = std::get_if<FramePtr>(&*next)) {
      return std::const_pointer_cast<RgbdFrame>(*frame);
    }
    const std::string& damage = std::get<DamagedFrame>(*next).damage;
    if (PyErr_WarnEx(PyExc_UserWarning, damage.c_str(), 1) != 0) throw py::error_already_set();
  }
}

void add_frame(py::module_& module) {
  py::class_<RgbdFrame, std::shared_ptr<RgbdFrame>>(module, "Frame", "A frame of a Sequence.")
      .def_property_readonly(
          "id", [](const RgbdFrame& self) { return self.id.value; }, "Its place, from 0.")
      .def_property_readonly(
          "stamp", [](const RgbdFrame& self) { return self.stamp.seconds; }, "Seconds.")
      .def_property_readonly(
          "stamp_text",
          [](const RgbdFrame& self) { return self.stamp.text; },
          "The stamp as the recording has it.")
      .def_property_readonly(
          "color",
          [](const RgbdFrame& self) { return image_array(self.color.mat); },
          "Red, green, blue, height x width x 3 uint8.")
      .def_property_readonly(
          "depth",
          [](const RgbdFrame& self) { return image_array(self.depth.mat); },
          "Metres, 0 = missing, height x width float32.")
      .def("__repr__", [](const RgbdFrame& self) {
        return fmt::format("<stillmap.Frame {}>", self.stamp.text);
      });
}

void add_sequence(py::module_& module) {
  py::class_<FrameStream>(module, "FrameIterator", "The frames of a Sequence, once.")
      .def("__iter__", [](const py::object& self) { return self; })
      .def("__next__", &next_frame, doc("__next__(self)", "The next Frame.").c_str());
  py::class_<SequenceFolder>(
      module, "Sequence", doc("Sequence(folder, camera=None)", kSequenceDoc).c_str())
      .def(py::init(&open_folder),
           py::arg("folder"),
           py::arg("camera") = py::none(),
           doc("__init__(self, folder, camera=None)", "See the class.").c_str())
      .def("__iter__", &SequenceFolder::open, doc("__iter__(self)", "From the start.").c_str())
      .def("__len__",
           [](const SequenceFolder& self) {
             if (self.frames) return *self.frames;
             throw Error("{}: the number of frames is not known", self.folder.string());
           })
      .def_readonly("folder", &SequenceFolder::folder, "Where it is.")
      .def_readonly("camera", &SequenceFolder::camera, "Its Camera.");
}

void add_writer(py::module_& module) {
  py::class_<DetectionsWriter>(module,
                               "DetectionsWriter",
                               doc("DetectionsWriter(folder, width, height)",
                                   "Writes a folder of detections (docs/detections.md): add() for "
                                   "each image, then finish().")
                                   .c_str())
      .def(py::init([](const std::filesystem::path& folder, int width, int height) {
             return std::make_unique<DetectionsWriter>(folder, cv::Size(width, height));
           }),
           py::arg("folder"),
           py::arg("width"),
           py::arg("height"),
           doc("__init__(self, folder, width, height)", "See the class.").c_str())
      .def(
          "add",
          [](DetectionsWriter& self, const py::object& stamp, FrameDetections objects) {
            objects.stamp = stamp_of(stamp);
            self.add(objects);
          },
          py::arg("stamp"),
          py::arg("objects"),
          doc("add(self, stamp, objects)",
              "The Detections of an image; stamps as the sequence has them, increasing.")
              .c_str())
      .def("finish", &DetectionsWriter::finish, doc("finish(self)", "Writes the list.").c_str());
}

}  // namespace

void add_recordings(py::module_& module) {
  add_frame(module);
  add_sequence(module);
  add_writer(module);
}

}  // namespace stillmap::python
