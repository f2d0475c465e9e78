// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "apps/sequence_option.hpp"
#include "apps/viewer_option.hpp"

namespace stillmap {

/// The command line of `stillmap run`.
struct RunArguments {
  SequenceArguments sequence;
  std::string device;          ///< instead of a sequence
  std::string save_recording;  ///< empty: no recording is kept
  std::string out;
  std::string config_file;
  std::vector<std::string> settings;
  std::optional<double> depth_factor;
  std::string segmenter;  ///< empty: auto where its networks are, else none
  std::string dynamics;   ///< empty: as configured
  std::string frames;
  std::size_t stride = 1;
  int threads = 2;
  bool live = false;
  double speed = 1;
  std::string replay;
  std::string load;
  bool localize_only = false;
  std::string groundtruth;
  std::string poses = "estimated";
  std::string objects_out;
  std::string inpainted;
  bool keep_movers = false;
  ViewerArguments viewer;
};

}  // namespace stillmap
