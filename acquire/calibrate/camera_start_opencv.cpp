// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/calibrate/camera_bundle.hpp>

#include <cmath>

#include <Eigen/LU>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>

namespace facula {
namespace {

struct Pairs {
  std::vector<cv::Point3f> on_board;  ///< in spacings: metres are too small for the solvers
  std::vector<cv::Point2f> seen;
  std::vector<std::size_t> index;  ///< into the view's points
};

RigidTransform pose_of(const cv::Mat& rotation_vector, const cv::Mat& translation, double spacing) {
  cv::Mat rotation;
  cv::Rodrigues(rotation_vector, rotation);
  Eigen::Matrix3d r;
  Eigen::Vector3d t;
  for (int i = 0; i < 3; ++i) {
    t[i] = translation.at<double>(i) * spacing;
    for (int j = 0; j < 3; ++j) r(i, j) = rotation.at<double>(i, j);
  }
  return {Eigen::Quaterniond(r).normalized(), t};
}

Pairs normalized_pairs(const Board& board, const BoardView& view, const Camera& camera) {
  Pairs pairs;
  for (std::size_t i = 0; i < view.ids.size(); ++i) {
    const auto ray = camera.undistort(view.pixels[i]);
    if (!ray) continue;
    const Eigen::Vector3d p = board.point(view.ids[i]) / board.spacing;
    pairs.on_board.emplace_back(p.x(), p.y(), p.z());
    pairs.seen.emplace_back(ray->x(), ray->y());
    pairs.index.push_back(i);
  }
  return pairs;
}

/// Of the two poses a flat board may have, the one that fits better (Collins and Bartoli 2014).
std::optional<RigidTransform> planar_pose(const Pairs& pairs, double spacing) {
  const cv::Mat unit = cv::Mat::eye(3, 3, CV_64F);
  cv::Mat rotation;
  cv::Mat translation;
  try {
    if (!cv::solvePnP(pairs.on_board,
                      pairs.seen,
                      unit,
                      cv::noArray(),
                      rotation,
                      translation,
                      false,
                      cv::SOLVEPNP_IPPE)) {
      return std::nullopt;
    }
  } catch (const cv::Exception&) {
    return std::nullopt;
  }
  const RigidTransform pose = pose_of(rotation, translation, spacing);
  if (!pose.translation.allFinite() || !(pose.translation.z() > 0)) return std::nullopt;
  return pose;
}

Pairs kept_pairs(const Pairs& pairs, const cv::Mat& mask) {
  Pairs kept;
  for (std::size_t i = 0; i < pairs.index.size(); ++i) {
    if (mask.at<std::uint8_t>(static_cast<int>(i)) == 0) continue;
    kept.on_board.push_back(pairs.on_board[i]);
    kept.seen.push_back(pairs.seen[i]);
    kept.index.push_back(pairs.index[i]);
  }
  return kept;
}

/// The pairs that one homography explains.
Pairs agreeing(const Pairs& pairs, double distance) {
  std::vector<cv::Point2f> flat;
  for (const cv::Point3f& p : pairs.on_board) flat.emplace_back(p.x, p.y);
  cv::Mat mask;
  try {
    cv::theRNG().state = 1;
    const cv::Mat homography =
        cv::findHomography(flat, pairs.seen, cv::RANSAC, distance, mask, 2000, 0.999);
    if (homography.empty()) return {};
  } catch (const cv::Exception&) {
    return {};
  }
  return kept_pairs(pairs, mask);
}

double closed_form_focal_length(const Board& board, const std::vector<BoardView>& views) {
  std::vector<std::vector<cv::Point3f>> on_board;
  std::vector<std::vector<cv::Point2f>> seen;
  for (const BoardView& view : views) {
    on_board.emplace_back();
    seen.emplace_back();
    for (std::size_t i = 0; i < view.ids.size(); ++i) {
      const Eigen::Vector3d p = board.point(view.ids[i]) / board.spacing;
      on_board.back().emplace_back(p.x(), p.y(), p.z());
      seen.back().emplace_back(view.pixels[i].x(), view.pixels[i].y());
    }
  }
  const double width = views.front().image_width;
  const double fallback = 1.2 * width;
  try {
    const cv::Mat k = cv::initCameraMatrix2D(
        on_board, seen, {views.front().image_width, views.front().image_height}, 1);
    const double f = k.at<double>(0, 0);
    return std::isfinite(f) && f > 0.2 * width && f < 30 * width ? f : fallback;
  } catch (const cv::Exception&) {
    return fallback;
  }
}

}  // namespace

CameraBundle start_bundle(const Board& board, const std::vector<BoardView>& views) {
  CameraBundle start;
  Camera& camera = start.camera;
  camera.width = views.front().image_width;
  camera.height = views.front().image_height;
  camera.fx = camera.fy = closed_form_focal_length(board, views);
  camera.cx = 0.5 * (camera.width - 1);
  camera.cy = 0.5 * (camera.height - 1);
  for (const BoardView& view : views) {
    const auto pose = planar_pose(normalized_pairs(board, view, camera), board.spacing);
    RigidTransform straight;
    straight.translation = Eigen::Vector3d(0, 0, 20 * board.spacing);
    start.poses.push_back(pose.value_or(straight));
  }
  return start;
}

std::optional<LocatedBoard> locate_robustly(const Board& board,
                                            const BoardView& view,
                                            const Camera& camera,
                                            double inlier_distance) {
  const Pairs pairs = normalized_pairs(board, view, camera);
  if (pairs.index.size() < 4) return std::nullopt;
  const Pairs inliers = agreeing(pairs, inlier_distance / std::sqrt(camera.fx * camera.fy));
  if (inliers.index.size() < 4) return std::nullopt;
  const auto pose = planar_pose(inliers, board.spacing);
  if (!pose) return std::nullopt;
  LocatedBoard located{*pose, view};
  located.inliers.ids.clear();
  located.inliers.pixels.clear();
  for (const std::size_t i : inliers.index) {
    located.inliers.ids.push_back(view.ids[i]);
    located.inliers.pixels.push_back(view.pixels[i]);
  }
  return located;
}

}  // namespace facula
