// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "stillmap/concurrency/channel.hpp"
#include "stillmap/io/folder_replacement.hpp"
#include "stillmap/sensor/frame_stream.hpp"

namespace stillmap {

/// Passes the frames of another stream on and keeps all of them as a recording in the layout of the
/// TUM RGB-D benchmark: rgb/, depth/, rgb.txt, depth.txt, associations.txt, camera.yaml.
///
/// Frames are passed on as they will be read from the recording, to the bit: with its positions as
/// ids, depth rounded to units of 1 / depth_factor, and stamps that are no seconds as seconds. So a
/// run on the recording can repeat the run that made it. Damaged frames are neither kept nor passed
/// on; warnings() counts them.
class RecordingStream : public FrameStream {
 public:
  /// `stream` outlives the object. Throws Error for a folder that is not new or empty.
  RecordingStream(FrameStream& stream, const std::filesystem::path& folder);
  ~RecordingStream() override;

  [[nodiscard]] const CameraModel& camera() const override { return camera_; }
  [[nodiscard]] std::optional<std::size_t> size() const override { return stream_.size(); }
  [[nodiscard]] bool ended_early() const override { return stream_.ended_early(); }
  /// Waits while many frames are not written yet. Throws also when one could not be written.
  [[nodiscard]] std::optional<StreamedFrame> next() override;
  [[nodiscard]] std::vector<std::string> warnings() const override;

  /// The number of frames kept.
  [[nodiscard]] std::size_t frames() const { return next_id_; }

  /// Writes the lists; only now the recording is there. Nothing appears without frames. To be
  /// called once, after the last next(). Throws Error when something could not be written.
  void finish();

 private:
  [[nodiscard]] FramePtr as_kept(const RgbdFrame& frame);
  void write_frames();

  static constexpr std::size_t kMaxWaiting = 30;
  FrameStream& stream_;
  CameraModel camera_;  // depth is registered already
  FolderReplacement files_;
  std::string rgb_list_ = "# color images\n# timestamp filename\n";
  std::string depth_list_ = "# depth images\n# timestamp filename\n";
  std::string pairs_;
  std::uint32_t next_id_ = 0;
  std::size_t damaged_ = 0;
  Channel<FramePtr> waiting_{kMaxWaiting};
  std::exception_ptr failure_;  // of the writer, once it has ended
  std::jthread writer_;         // last member: it uses the others until it is joined
};

}  // namespace stillmap
