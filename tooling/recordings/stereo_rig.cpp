// SPDX-License-Identifier: Apache-2.0
#include "tooling/recordings/stereo_rig.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "stillmap/core/error.hpp"
#include "stillmap/core/rgbd_frame.hpp"

namespace stillmap {
namespace {

cv::Matx33d matrix_of(const CameraModel& camera) {
  return {camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1};
}

cv::Vec<double, 8> distortion_of(const CameraModel& c) {
  return {c.k1, c.k2, c.p1, c.p2, c.k3, c.k4, c.k5, c.k6};
}

bool is_rectified(const StereoCalibration& calibration) {
  const CameraModel &left = calibration.left, &right = calibration.right;
  const Eigen::Vector3d way = calibration.T_left_right.translation();
  return !left.distorted() && !right.distorted() && left.fx == right.fx && left.fy == right.fy &&
         left.fx == left.fy && left.cx == right.cx && left.cy == right.cy &&
         calibration.T_left_right.rotation().isIdentity(1e-9) &&
         way.tail<2>().norm() <= 1e-9 * std::abs(way.x());
}

// Greatest disparity searched for: a multiple of 16, as the matcher wants it.
int greatest_disparity(int width_px) {
  return std::max(16, 16 * static_cast<int>(std::lround(width_px / 96.0)));
}

// The matcher finds nothing in the columns whose greatest disparity leads out of the image. With as
// many columns more on the left, it finds what is there.
cv::Mat widened(const ColorImage& color, int columns) {
  cv::Mat wide;
  cv::copyMakeBorder(to_gray(color).mat, wide, 0, 0, columns, 0, cv::BORDER_REPLICATE);
  return wide;
}

cv::Ptr<cv::StereoSGBM> make_matcher(int disparities) {
  constexpr int kBlock = 5, kArea = kBlock * kBlock;
  constexpr int kLeftRightPx = 1, kPrefilter = 31, kUnique = 10;
  constexpr int kSpecklePixels = 100, kSpecklePx = 2;
  return cv::StereoSGBM::create(0,
                                disparities,
                                kBlock,
                                8 * kArea,
                                32 * kArea,
                                kLeftRightPx,
                                kPrefilter,
                                kUnique,
                                kSpecklePixels,
                                kSpecklePx,
                                cv::StereoSGBM::MODE_SGBM);
}

ColorImage remapped(const ColorImage& color, const cv::Mat& x, const cv::Mat& y) {
  if (x.empty()) return color;
  cv::Mat3b rectified;
  cv::remap(color.mat, rectified, x, y, cv::INTER_LINEAR, cv::BORDER_CONSTANT);
  return ColorImage(rectified);
}

}  // namespace

StereoRig::StereoRig(const StereoCalibration& calibration, const std::string& place)
    : camera_(calibration.left) {
  const CameraModel &left = calibration.left, &right = calibration.right;
  if (left.width_px != right.width_px || left.height_px != right.height_px) {
    throw Error("{}: the left camera has {}x{} pixels, the right one {}x{}; expected equal sizes",
                place,
                left.width_px,
                left.height_px,
                right.width_px,
                right.height_px);
  }
  const Eigen::Vector3d way = calibration.T_left_right.translation();
  if (!(way.x() > way.tail<2>().norm())) {
    throw Error(
        "{}: the second camera is at ({:.3f}, {:.3f}, {:.3f}) m of the first one, expected "
        "a camera to the right of it",
        place,
        way.x(),
        way.y(),
        way.z());
  }
  if (is_rectified(calibration)) {
    baseline_m_ = way.x();
  } else {
    rectify(calibration, place);
  }
}

void StereoRig::rectify(const StereoCalibration& calibration, const std::string& place) {
  const CameraModel &left = calibration.left, &right = calibration.right;
  const cv::Size size(left.width_px, left.height_px);
  const Eigen::Isometry3d T_right_left = calibration.T_left_right.inverse();
  const Eigen::Matrix3d R = T_right_left.rotation();
  const Eigen::Vector3d t = T_right_left.translation();
  const cv::Matx33d rotation(
      R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2), R(2, 0), R(2, 1), R(2, 2));
  const cv::Matx31d translation(t.x(), t.y(), t.z());
  const cv::Matx33d K_left = matrix_of(left), K_right = matrix_of(right);
  const auto D_left = distortion_of(left), D_right = distortion_of(right);
  cv::Matx33d turn_left, turn_right;
  cv::Matx34d P_left, P_right;
  cv::Matx44d ignored;
  cv::stereoRectify(K_left,
                    D_left,
                    K_right,
                    D_right,
                    size,
                    rotation,
                    translation,
                    turn_left,
                    turn_right,
                    P_left,
                    P_right,
                    ignored,
                    cv::CALIB_ZERO_DISPARITY,
                    0,
                    size);
  baseline_m_ = -P_right(0, 3) / P_right(0, 0);
  if (!(baseline_m_ > 0) || !std::isfinite(P_left(0, 0)) || !(P_left(0, 0) > 0)) {
    throw Error("{}: the two cameras cannot be rectified; is this their calibration?", place);
  }
  const auto make_maps =
      [&](Maps& maps, const auto& K, const auto& D, const auto& turn, const auto& P) {
        cv::initUndistortRectifyMap(K, D, turn, P, size, CV_32FC1, maps.x, maps.y);
      };
  make_maps(left_, K_left, D_left, turn_left, P_left);
  make_maps(right_, K_right, D_right, turn_right, P_right);
  camera_ = {};
  camera_.name = left.name;
  camera_.width_px = left.width_px;
  camera_.height_px = left.height_px;
  camera_.fx = P_left(0, 0);
  camera_.fy = P_left(1, 1);
  camera_.cx = P_left(0, 2);
  camera_.cy = P_left(1, 2);
  Eigen::Matrix3d turn;  // of rectified coordinates
  for (int i = 0; i < 9; ++i) turn(i / 3, i % 3) = turn_left(i / 3, i % 3);
  T_left_rectified_.linear() = turn.transpose();
}

ColorImage StereoRig::rectified_left(const ColorImage& left) const {
  return remapped(left, left_.x, left_.y);
}

ColorImage StereoRig::rectified_right(const ColorImage& right) const {
  return remapped(right, right_.x, right_.y);
}

DepthImage StereoRig::depth(const ColorImage& left, const ColorImage& right) const {
  constexpr float kSubpixels = 16;
  const int disparities = greatest_disparity(camera_.width_px);
  cv::Mat1s wide;
  make_matcher(disparities)->compute(widened(left, disparities), widened(right, disparities), wide);
  const cv::Mat1s units = wide.colRange(disparities, wide.cols);
  const float product = static_cast<float>(camera_.fx * baseline_m_);
  cv::Mat1f metres(units.size());
  std::transform(units.begin(), units.end(), metres.begin(), [product](std::int16_t unit) {
    const float disparity_px = static_cast<float>(unit) / kSubpixels;
    return disparity_px >= static_cast<float>(kLeastDisparityPx) ? product / disparity_px : 0.F;
  });
  return DepthImage(metres);
}

DepthNoise StereoRig::noise() const {
  const double product = camera_.fx * baseline_m_;
  return {kDisparitySigmaPx / product, product / kLeastDisparityPx};
}

}  // namespace stillmap
