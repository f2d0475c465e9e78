// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <opencv2/core/types.hpp>

#include "stillmap/perception/segmentation/export_kind.hpp"

namespace stillmap {

/// A kind that the shapes of a network's outputs allow, before its classes have names.
struct ExportReading {
  NetworkExport network;
  std::optional<std::int64_t> classes;  ///< nothing: the shapes do not tell
  bool with_background = false;         ///< class 0 is the background
};

/// All kinds that the shapes allow, the likelier first; empty for none. `input` is the size of the
/// image that the network takes.
[[nodiscard]] std::vector<ExportReading> readings_of(const std::vector<Tensor>& outputs,
                                                     cv::Size input);

/// The contradiction of a kind by the values, in words: "a score of 7.5, expected ..."; empty if
/// there is none. `network` has its names.
[[nodiscard]] std::string contradiction(const NetworkExport& network,
                                        const std::vector<Tensor>& outputs);

}  // namespace stillmap
