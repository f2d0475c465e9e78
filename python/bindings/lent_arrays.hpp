// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>
#include <vector>

#include <opencv2/core/mat.hpp>
#include <pybind11/numpy.h>

namespace stillmap::python {

/// Lends the pixels of numpy arrays to images, without copying them. An array is kept as long as
/// an image shares its pixels. Images may end on any thread, also while Python shuts down, where no
/// thread but the main one may touch Python's objects; so an array is given up by the next call of
/// give_up_unused().
class LentArrays final : public cv::MatAllocator {
 public:
  LentArrays() = default;
  LentArrays(const LentArrays&) = delete;
  LentArrays& operator=(const LentArrays&) = delete;
  /// All images have ended. The caller holds the GIL.
  ~LentArrays() override;

  /// An image of the array's pixels: `type` is OpenCV's, rows are `step` bytes apart. It must not
  /// outlive this object.
  [[nodiscard]] cv::Mat lend(const pybind11::array& array, int type);
  /// Gives up the arrays of which no image is left. The caller holds the GIL.
  void give_up_unused();

 private:
  cv::UMatData* allocate(int dims,
                         const int* sizes,
                         int type,
                         void* data,
                         std::size_t* step,
                         cv::AccessFlag flags,
                         cv::UMatUsageFlags usage) const override;
  bool allocate(cv::UMatData* data, cv::AccessFlag flags, cv::UMatUsageFlags usage) const override;
  void deallocate(cv::UMatData* data) const override;

  mutable std::mutex mutex_;
  mutable std::vector<PyObject*> unused_;  // each holds one reference
};

}  // namespace stillmap::python
