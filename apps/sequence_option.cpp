// SPDX-License-Identifier: Apache-2.0
#include "apps/sequence_option.hpp"

#include <algorithm>
#include <vector>

#include "stillmap/core/error.hpp"
#include "stillmap/core/joined.hpp"
#include "stillmap/io/stamp_unit.hpp"
#include "stillmap/sensor/camera_io.hpp"
#include "tooling/recordings/recording_formats.hpp"

namespace stillmap {

CLI::Option* add_sequence_options(CLI::App& command, SequenceArguments& arguments) {
  std::vector<std::string> formats, units;
  for (const SequenceFormat& format : recording_formats()) formats.emplace_back(format.name);
  for (const StampUnitName& unit : kStampUnitNames) units.emplace_back(unit.option);
  CLI::Option* const sequence = command.add_option(
      "SEQUENCE", arguments.path, "recording: a folder or a bag, see docs/inputs.md");
  sequence->required();
  command
      .add_option("--format",
                  arguments.format,
                  fmt::format("format of the recording, where it is not recognised: {}",
                              joined(formats, ", ")))
      ->check(CLI::IsMember(formats));
  command.add_option("--rate", arguments.rate_hz, "frames a second, where they are only numbered")
      ->check(CLI::Range(0.01, 1000.0))
      ->capture_default_str();
  command
      .add_option(
          "--stamps",
          arguments.stamps,
          fmt::format("unit of the stamps, where it is not recognised: {}", joined(units, ", ")))
      ->check(CLI::IsMember(units));
  command.add_option("--color-topic", arguments.color_topic, "of a bag or a robot with several");
  command.add_option("--depth-topic", arguments.depth_topic, "of a bag or a robot with several");
  return sequence;
}

SequenceOptions sequence_options(const SequenceArguments& arguments) {
  SequenceOptions options;
  if (!arguments.camera.empty()) options.camera = camera_by_name(arguments.camera);
  options.format = arguments.format;
  options.formats = recording_formats();
  options.reading.color_topic = arguments.color_topic;
  options.reading.depth_topic = arguments.depth_topic;
  options.reading.rate_hz = arguments.rate_hz;
  const auto unit = std::ranges::find(kStampUnitNames, arguments.stamps, &StampUnitName::option);
  if (unit != kStampUnitNames.end()) options.reading.stamp_unit = unit->unit;
  return options;
}

Sequence open_sequence(const SequenceArguments& arguments) {
  try {
    return Sequence::open(arguments.path, sequence_options(arguments));
  } catch (const UnknownCamera& error) {
    throw UnknownCamera("{} (--camera NAME or FILE names it)", error.what());
  }
}

SequenceContent open_content(const SequenceArguments& arguments) {
  const SequenceOptions options = sequence_options(arguments);
  return choose_format(arguments.path, options.format, options.formats)
      .open(arguments.path, options.reading);
}

std::string input_line(const Sequence& sequence) {
  std::string line(sequence.format());
  for (const std::string& note : sequence.remarks().notes) line += "; " + note;
  return line;
}

}  // namespace stillmap
