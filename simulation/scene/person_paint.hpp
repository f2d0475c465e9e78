// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>

#include "simulation/scene/person_look.hpp"

namespace stillmap {

/// The shirt's cloth, which repeats: kClothTile_m square.
[[nodiscard]] cv::Mat3b paint_cloth(const PersonLook& look);

/// The shirt unrolled about the trunk: from the back seam round over the person's right, front and
/// left to the seam (u), from kTrunkTop_m down to kTrunkBottom_m over the pelvis joint (v).
[[nodiscard]] cv::Mat3b paint_trunk(const PersonLook& look);

/// Denim or twill with seams, which repeats: kClothTile_m square.
[[nodiscard]] cv::Mat3b paint_trousers(const PersonLook& look);

/// Strands, which repeat: kClothTile_m square.
[[nodiscard]] cv::Mat3b paint_hair(const PersonLook& look);

/// Skin with slight mottling, which repeats: kClothTile_m square.
[[nodiscard]] cv::Mat3b paint_skin(const PersonLook& look);

/// The face from the front, kFaceWidth_m by kFaceHeight_m: the person's right on the left.
[[nodiscard]] cv::Mat3b paint_face(const PersonLook& look);

inline constexpr float kClothTile_m = 0.25F;
inline constexpr float kTrunkTop_m = 0.52F;
inline constexpr float kTrunkBottom_m = -0.12F;
inline constexpr float kTrunkGirth_m = 0.90F;
inline constexpr float kFaceWidth_m = 0.18F;
inline constexpr float kFaceHeight_m = 0.24F;
/// Height of the face picture's top over the pelvis joint at 1.75 m of height.
inline constexpr float kFaceTop_m = 0.795F;

}  // namespace stillmap
