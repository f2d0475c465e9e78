// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "stillmap/sensor/sequence.hpp"

namespace stillmap {

/// A recording as the command line names it.
struct SequenceArguments {
  std::string path;
  std::string camera;  ///< empty: the recording's own
  std::string format;  ///< empty: as it looks
  double rate_hz = 30;
  std::string stamps;  ///< empty: as they look
  std::string color_topic;
  std::string depth_topic;
};

/// Adds SEQUENCE, --format, --rate, --stamps and the topics of a bag. Returns SEQUENCE, which is
/// required.
CLI::Option* add_sequence_options(CLI::App& command, SequenceArguments& arguments);

/// What the options say of how the recording is read.
[[nodiscard]] SequenceOptions sequence_options(const SequenceArguments& arguments);

/// Opens the recording. Throws Error as Sequence::open() does, naming --camera where the camera is
/// not known.
[[nodiscard]] Sequence open_sequence(const SequenceArguments& arguments);

/// Opens the recording where its camera does not matter.
[[nodiscard]] SequenceContent open_content(const SequenceArguments& arguments);

/// How a recording was understood: "images; names of images: stamps are frame numbers, at 30 Hz".
[[nodiscard]] std::string input_line(const Sequence& sequence);

}  // namespace stillmap
