// SPDX-License-Identifier: Apache-2.0
#include "python/bindings/objects.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <pybind11/stl.h>

#include "python/bindings/arrays.hpp"
#include "python/bindings/bindings.hpp"
#include "python/bindings/pixels.hpp"
#include "stillmap/core/error.hpp"
#include "stillmap/core/joined.hpp"
#include "stillmap/perception/detections/class_names.hpp"
#include "stillmap/perception/detections/detections_line.hpp"
#include "stillmap/perception/objects/object_state.hpp"
#include "stillmap/perception/segmentation/segmenter.hpp"

namespace stillmap::python {

namespace py = pybind11;

namespace {

constexpr std::size_t kMostObjects = 255;

constexpr const char* kDetectionsDoc =
    R"(The objects that a network found in one image.

`class_names`: a name for each object, such as "person"; names of VOC and usual ones become COCO's.
`scores`: the network's confidence, 0 to 1; 1 if not given.
`boxes`: N x 4, [x0, y0, x1, y1] in pixels, x1 and y1 exclusive; those of the masks if not given.
`masks`: N x height x width, not 0 where the object is (where masks overlap, the highest score
counts), or one height x width uint8 that is i + 1 where object i is. None: the network gives boxes
alone, and masks come from depth.)";
constexpr const char* kSegmenterDoc =
    R"(What finds people and things in colour images: a function from an image to Detections.

    find = Segmenter("auto")            # the networks of `make models`
    find = Segmenter("onnx:yolov8n-seg.onnx")
    objects = find(color)

Also "detections:DIR" and "masks:DIR", for which the stamp of the image has to be given. Any other
function from a color array to Detections may stand in its place. All images of one Segmenter have
one size. `threads`: for one run of a network.)";

// The id of each pixel, from one mask for each object; the best score is painted last.
cv::Mat1b painted(const py::array& masks, const std::vector<float>& scores) {
  const auto bytes = py::array_t<std::uint8_t, py::array::c_style | py::array::forcecast>(
      masks.attr("astype")("bool"));
  std::vector<std::size_t> order(scores.size());
  std::iota(order.rbegin(), order.rend(), 0U);
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return scores[i]; });
  const auto rows = static_cast<int>(bytes.shape(1)), columns = static_cast<int>(bytes.shape(2));
  cv::Mat1b ids(rows, columns, std::uint8_t{0});
  for (const std::size_t i : order) {
    paint(ids, bytes.data(static_cast<py::ssize_t>(i), 0, 0), static_cast<std::uint8_t>(i + 1));
  }
  return ids;
}

ObjectMask mask_of(const py::object& masks, const std::vector<float>& scores) {
  if (masks.is_none()) return {};
  const py::array array = py::array::ensure(masks);
  const auto count = static_cast<py::ssize_t>(scores.size());
  if (array && array.ndim() == 3 && array.shape(0) == count) {
    return count == 0 ? ObjectMask() : ObjectMask(painted(array, scores));
  }
  if (!array || array.ndim() != 2 || !py::isinstance<py::array_t<std::uint8_t>>(array)) {
    PyErr_Clear();
    throw Error("masks: {}, expected {} x height x width, or height x width uint8",
                description_of(masks),
                count);
  }
  cv::Mat1b ids(static_cast<int>(array.shape(0)), static_cast<int>(array.shape(1)));
  const py::array_t<std::uint8_t, py::array::c_style> rows(array);
  std::copy_n(rows.data(), ids.total(), ids.begin());
  const std::uint8_t largest =
      ids.empty() ? std::uint8_t{0} : *std::max_element(ids.begin(), ids.end());
  if (largest > count) {
    throw Error("masks: a pixel of object {}, but there are {} objects", int{largest}, count);
  }
  return ObjectMask(ids);
}

std::vector<PixelBox> boxes_of_mask(const ObjectMask& mask, std::size_t count) {
  if (mask.mat.empty() && count > 0) throw Error("boxes: missing; expected boxes or masks");
  std::vector<PixelBox> boxes = boxes_around(mask.mat, count);
  for (std::size_t i = 0; i < count; ++i) {
    if (boxes[i].area() > 0) continue;
    throw Error("masks: object {} has no pixel; give boxes, or leave it out", i);
  }
  return boxes;
}

std::vector<PixelBox> boxes_of(const py::object& boxes, std::size_t count) {
  const auto rows = rows_of<double>(boxes, "boxes", 4);
  if (static_cast<std::size_t>(rows.shape(0)) != count) {
    throw Error("boxes: {} of them, expected one for each of {} objects", rows.shape(0), count);
  }
  std::vector<PixelBox> result;
  for (py::ssize_t i = 0; i < rows.shape(0); ++i) {
    result.push_back({rows.at(i, 0), rows.at(i, 1), rows.at(i, 2), rows.at(i, 3)});
  }
  return result;
}

FrameDetections make_detections(const std::vector<std::string>& class_names,
                                const std::optional<std::vector<float>>& given_scores,
                                const py::object& boxes,
                                const py::object& masks) {
  const std::size_t count = class_names.size();
  if (count > kMostObjects) throw Error("{} objects, at most {}", count, kMostObjects);
  const std::vector<float> scores = given_scores.value_or(std::vector<float>(count, 1.0F));
  if (scores.size() != count) {
    throw Error("scores: {} of them, expected one for each of {} objects", scores.size(), count);
  }
  FrameDetections found;
  found.mask = mask_of(masks, scores);
  const std::vector<PixelBox> at =
      boxes.is_none() ? boxes_of_mask(found.mask, count) : boxes_of(boxes, count);
  for (std::size_t i = 0; i < count; ++i) {
    found.objects.push_back({static_cast<int>(i) + 1, coco_name(class_names[i]), scores[i], at[i]});
  }
  return found;
}

py::tuple box_tuple(const PixelBox& box) {
  return py::make_tuple(box.x0, box.y0, box.x1, box.y1);
}

py::array boxes_array(const FrameDetections& found) {
  py::array_t<double> array({static_cast<py::ssize_t>(found.objects.size()), py::ssize_t{4}});
  double* value = array.mutable_data();
  for (const DetectedObject& object : found.objects) {
    for (const double edge : {object.box.x0, object.box.y0, object.box.x1, object.box.y1}) {
      *value++ = edge;
    }
  }
  return array;
}

std::vector<std::string> names_of(const FrameDetections& found) {
  std::vector<std::string> names;
  for (const DetectedObject& object : found.objects) names.push_back(object.class_name);
  return names;
}

py::array scores_array(const FrameDetections& found) {
  py::array_t<float> array(static_cast<py::ssize_t>(found.objects.size()));
  float* value = array.mutable_data();
  for (const DetectedObject& object : found.objects) *value++ = object.score;
  return array;
}

// A segmenter that is made when the size of its images is known.
class LazySegmenter {
 public:
  LazySegmenter(std::string description, int threads)
      : description_(std::move(description)), threads_(threads) {}

  FrameDetections find(const py::object& color, const py::object& stamp) {
    LentArrays lent;
    const ColorImage image = color_image(color, lent);
    const Stamp time = python::stamp_of(stamp);
    const py::gil_scoped_release release;
    const std::shared_ptr<const Segmenter> network = made_for(image.mat.size());
    return numbered_in_order(network->segment(image, time));
  }
  [[nodiscard]] const std::string& description() const { return description_; }

 private:
  std::shared_ptr<const Segmenter> made_for(cv::Size image) {
    const std::lock_guard lock(mutex_);
    if (network_ == nullptr) {
      network_ = make_segmenter(description_, image, {.threads = threads_});
      image_ = image;
    }
    if (image == image_) return network_;
    throw Error("color: {} x {} x 3, expected {} x {} x 3 as the image before",
                image.height,
                image.width,
                image_.height,
                image_.width);
  }

  std::string description_;
  int threads_;
  std::mutex mutex_;
  std::shared_ptr<const Segmenter> network_;  // null until the first image
  cv::Size image_;
};

void add_detections(py::module_& module) {
  const char* signature = "class_names=(), scores=None, boxes=None, masks=None)";
  py::class_<FrameDetections>(
      module, "Detections", doc(std::string("Detections(") + signature, kDetectionsDoc).c_str())
      .def(py::init(&make_detections),
           py::arg("class_names") = py::tuple(),
           py::arg("scores") = py::none(),
           py::arg("boxes") = py::none(),
           py::arg("masks") = py::none(),
           doc(std::string("__init__(self, ") + signature, "See the class.").c_str())
      .def_property_readonly("class_names", &names_of, "A name for each object.")
      .def_property_readonly("scores", &scores_array, "Confidence of the network, N float32.")
      .def_property_readonly("boxes", &boxes_array, "[x0, y0, x1, y1] in pixels, N x 4 float64.")
      .def_property_readonly(
          "mask",
          [](const FrameDetections& self) { return image_array(self.mask.mat); },
          "height x width uint8: i + 1 where object i is; None where no object has pixels.")
      .def("__len__", [](const FrameDetections& self) { return self.objects.size(); })
      .def("__repr__", [](const FrameDetections& self) {
        return fmt::format("<stillmap.Detections: {}>", joined(names_of(self), ", "));
      });
}

void add_segmenter(py::module_& module) {
  py::class_<LazySegmenter>(
      module, "Segmenter", doc("Segmenter(description='auto', threads=2)", kSegmenterDoc).c_str())
      .def(py::init<std::string, int>(),
           py::arg("description") = "auto",
           py::arg("threads") = 2,
           doc("__init__(self, description='auto', threads=2)", "See the class.").c_str())
      .def("__call__",
           &LazySegmenter::find,
           py::arg("color"),
           py::arg("stamp") = 0.0,
           doc("__call__(self, color, stamp=0.0)", "The objects in an image.").c_str())
      .def("__repr__", [](const LazySegmenter& self) {
        return fmt::format("<stillmap.Segmenter {}>", self.description());
      });
}

// Motion, which has no class of its own in Python.
void add_motion(py::class_<ObjectState>& state) {
  state
      .def_property_readonly(
          "motion",
          [](const ObjectState& self) { return std::string(motion_name(self.motion.state)); },
          "What is known of its motion, in the words of objects.jsonl.")
      .def_property_readonly(
          "position",
          [](const ObjectState& self) -> py::object {
            if (!self.motion.p_world) return py::none();
            return py::array_t<double>(3, self.motion.p_world->data());
          },
          "The middle of the visible surface in the world, metres; None without depth.")
      .def_property_readonly(
          "velocity",
          [](const ObjectState& self) {
            return py::array_t<double>(3, self.motion.velocity_m_s.data());
          },
          "In the world, metres per second; 0 where it is not known.")
      .def_property_readonly(
          "velocity_error",
          [](const ObjectState& self) { return self.motion.velocity_error_m_s; },
          "Standard error of the velocity's length, metres per second.")
      .def_property_readonly(
          "moved_by",
          [](const ObjectState& self) -> std::optional<std::uint32_t> {
            if (!self.motion.by) return std::nullopt;
            return self.motion.by->value;
          },
          "The track of the person who moves it, or None.");
}

void add_object_state(py::module_& module) {
  py::class_<ObjectState> state(module, "ObjectState", "What is known of one object in one frame.");
  state
      .def_property_readonly(
          "track",
          [](const ObjectState& self) { return self.track.value; },
          "Its number, the same in all its frames.")
      .def_readonly("class_name", &ObjectState::class_name, "The COCO name if there is one.")
      .def_property_readonly(
          "category",
          [](const ObjectState& self) { return std::string(category_name(self.category)); },
          "Whether objects of its class move, in the words of objects.jsonl.")
      .def_readonly("dynamic", &ObjectState::dynamic, "Whether it is taken for moving here.")
      .def_property_readonly(
          "reason",
          [](const ObjectState& self) { return std::string(reason_name(self.reason)); },
          "Why it is dynamic or not, in the words of objects.jsonl.")
      .def_property_readonly(
          "box",
          [](const ObjectState& self) { return box_tuple(self.box); },
          "(x0, y0, x1, y1) in pixels.")
      .def_readonly("score", &ObjectState::score, "Of the network, when it was seen last.")
      .def_readonly("filled", &ObjectState::filled, "Whether the network missed it here.")
      .def_readonly("median_depth", &ObjectState::median_depth_m, "Metres; 0 without depth.")
      .def("__repr__", [](const ObjectState& self) {
        return fmt::format("<stillmap.ObjectState {} {}, {}>",
                           self.class_name,
                           self.track.value,
                           self.dynamic ? "dynamic" : "static");
      });
  add_motion(state);
}

// Whether an object is one of those that a line of detections certainly allows: its box ends in the
// image or near it.
bool is_usual(const DetectedObject& object, cv::Size image) {
  const PixelBox& box = object.box;
  return is_class_name(object.class_name) && object.score >= 0.0F && object.score <= 1.0F &&
         box.x0 < box.x1 && box.y0 < box.y1 && box.x0 >= -image.width && box.y0 >= -image.height &&
         box.x1 <= 2.0 * image.width && box.y1 <= 2.0 * image.height;
}

}  // namespace

FrameDetections checked_detections(FrameDetections detections, cv::Size image) {
  detections.stamp = {0, "0"};  // the line needs one
  // The line says what is wrong, but takes a tenth of a millisecond.
  if (!std::ranges::all_of(detections.objects,
                           [&](const DetectedObject& object) { return is_usual(object, image); })) {
    (void)parse_detections_line(format_detections_line(detections), image, "objects");
  }
  const cv::Mat1b& mask = detections.mask.mat;
  if (mask.empty() || mask.size() == image) return detections;
  throw Error("objects: masks of {} x {} pixels, expected {} x {} as the image has",
              mask.rows,
              mask.cols,
              image.height,
              image.width);
}

void add_objects(py::module_& module) {
  add_detections(module);
  add_segmenter(module);
  add_object_state(module);
}

}  // namespace stillmap::python
