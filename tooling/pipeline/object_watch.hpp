// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <set>
#include <string>

#include "stillmap/perception/objects/categories.hpp"
#include "stillmap/system/observer.hpp"

namespace stillmap {

/// Warns of a network that may not suit the images: one that finds no object of a dynamic class in
/// the first five seconds of stamps, or never, and one with unknown classes.
class ObjectWatch : public Observer {
 public:
  using Warn = std::function<void(const std::string& warning)>;

  /// `warn` gets each warning, once, in one line.
  ObjectWatch(const CategoryConfig& categories, Warn warn);

  void on_frame(const RgbdFrame& frame, const FrameResult& result) override;
  void on_end(const RunResult& result) override;

  /// From the stamp of the first frame to that of the first with an object of a dynamic class;
  /// nothing if there was none.
  [[nodiscard]] std::optional<double> first_dynamic_s() const { return first_dynamic_s_; }

 private:
  CategoryTable categories_;
  Warn warn_;
  std::size_t frames_ = 0;
  double start_s_ = 0;
  bool warned_early_ = false;
  std::optional<double> first_dynamic_s_;
  std::set<std::string> unknown_;
};

/// The warning for classes that count as static because they are unknown. `names` is not empty; the
/// first ten are named.
[[nodiscard]] std::string unknown_classes_warning(const std::set<std::string>& names);

}  // namespace stillmap
