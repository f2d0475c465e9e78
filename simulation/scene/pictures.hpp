// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <opencv2/core/mat.hpp>

namespace stillmap {

/// The pictures on the things of an office. Each has the given size in metres and depends on its
/// arguments alone. Another seed gives other words, lines and tones, so that no two pictures of an
/// office are equal.
using PictureSeed = std::uint64_t;

// The room.
[[nodiscard]] cv::Mat3b plaster_picture(cv::Size2d size_m, PictureSeed seed);
[[nodiscard]] cv::Mat3b carpet_picture(cv::Size2d size_m, PictureSeed seed);
[[nodiscard]] cv::Mat3b ceiling_picture(cv::Size2d size_m, PictureSeed seed);
[[nodiscard]] cv::Mat3b lamp_panel_picture(cv::Size2d size_m, PictureSeed seed);
[[nodiscard]] cv::Mat3b outdoor_picture(cv::Size2d size_m,
                                        PictureSeed seed);  ///< houses, trees, sky
[[nodiscard]] cv::Mat3b door_picture(cv::Size2d size_m, PictureSeed seed);
[[nodiscard]] cv::Mat3b socket_picture(cv::Size2d size_m, PictureSeed seed);

// On the walls.
[[nodiscard]] cv::Mat3b world_map_picture(cv::Size2d size_m, PictureSeed seed);
[[nodiscard]] cv::Mat3b landscape_picture(cv::Size2d size_m, PictureSeed seed);
[[nodiscard]] cv::Mat3b abstract_picture(cv::Size2d size_m, PictureSeed seed);
[[nodiscard]] cv::Mat3b science_poster_picture(cv::Size2d size_m, PictureSeed seed);
[[nodiscard]] cv::Mat3b calendar_picture(cv::Size2d size_m, PictureSeed seed);
[[nodiscard]] cv::Mat3b clock_picture(cv::Size2d size_m, PictureSeed seed);
[[nodiscard]] cv::Mat3b whiteboard_picture(cv::Size2d size_m, PictureSeed seed);
[[nodiscard]] cv::Mat3b pinboard_picture(cv::Size2d size_m, PictureSeed seed);

// Furniture and what lies about.
[[nodiscard]] cv::Mat3b wood_picture(cv::Size2d size_m, const cv::Vec3b& tone, PictureSeed seed);
[[nodiscard]] cv::Mat3b fabric_picture(cv::Size2d size_m, const cv::Vec3b& tone, PictureSeed seed);
[[nodiscard]] cv::Mat3b screen_picture(cv::Size2d size_m, PictureSeed seed);
[[nodiscard]] cv::Mat3b keyboard_picture(cv::Size2d size_m, PictureSeed seed);
[[nodiscard]] cv::Mat3b phone_picture(cv::Size2d size_m, PictureSeed seed);
[[nodiscard]] cv::Mat3b paper_picture(cv::Size2d size_m, PictureSeed seed);
[[nodiscard]] cv::Mat3b book_cover_picture(cv::Size2d size_m,
                                           const cv::Vec3b& tone,
                                           PictureSeed seed);
[[nodiscard]] cv::Mat3b book_spine_picture(cv::Size2d size_m,
                                           const cv::Vec3b& tone,
                                           PictureSeed seed);
[[nodiscard]] cv::Mat3b page_edges_picture(cv::Size2d size_m, PictureSeed seed);
[[nodiscard]] cv::Mat3b binder_picture(cv::Size2d size_m, const cv::Vec3b& tone, PictureSeed seed);
[[nodiscard]] cv::Mat3b mug_picture(cv::Size2d size_m, const cv::Vec3b& tone, PictureSeed seed);
[[nodiscard]] cv::Mat3b carton_side_picture(cv::Size2d size_m, PictureSeed seed);
[[nodiscard]] cv::Mat3b carton_top_picture(cv::Size2d size_m, PictureSeed seed);

}  // namespace stillmap
