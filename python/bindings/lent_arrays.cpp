// SPDX-License-Identifier: Apache-2.0
#include "python/bindings/lent_arrays.hpp"

#include <utility>

#include "stillmap/core/error.hpp"

namespace stillmap::python {

namespace py = pybind11;

LentArrays::~LentArrays() {
  give_up_unused();
}

cv::Mat LentArrays::lend(const py::array& array, int type) {
  // OpenCV has no image of constant pixels. No function of stillmap writes to an image it was
  // given.
  auto* const pixels = static_cast<uchar*>(const_cast<void*>(array.data()));
  const auto rows = static_cast<int>(array.shape(0)), columns = static_cast<int>(array.shape(1));
  cv::Mat image(rows, columns, type, pixels, static_cast<std::size_t>(array.strides(0)));
  auto* const data = new cv::UMatData(this);
  data->data = data->origdata = pixels;
  data->size = static_cast<std::size_t>(array.strides(0)) * static_cast<std::size_t>(rows);
  data->userdata = array.inc_ref().ptr();
  data->refcount = 1;
  image.u = data;
  return image;
}

void LentArrays::give_up_unused() {
  std::vector<PyObject*> unused;
  {
    const std::lock_guard lock(mutex_);
    unused = std::exchange(unused_, {});
  }
  for (PyObject* const array : unused) Py_DECREF(array);
}

// Images of other pixels are made by OpenCV's own allocator.
cv::UMatData* LentArrays::allocate(int /*dims*/,
                                   const int* /*sizes*/,
                                   int /*type*/,
                                   void* /*data*/,
                                   std::size_t* /*step*/,
                                   cv::AccessFlag /*flags*/,
                                   cv::UMatUsageFlags /*usage*/) const {
  throw InternalError("lent pixels cannot be allocated");
}

bool LentArrays::allocate(cv::UMatData* /*data*/,
                          cv::AccessFlag /*flags*/,
                          cv::UMatUsageFlags /*usage*/) const {
  return false;
}

void LentArrays::deallocate(cv::UMatData* data) const {
  {
    const std::lock_guard lock(mutex_);
    unused_.push_back(static_cast<PyObject*>(data->userdata));
  }
  delete data;
}

}  // namespace stillmap::python
