// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/calibrate/camera_bundle.hpp>
#include <facula/acquire/calibrate/camera_calibration.hpp>
#include <facula/acquire/calibrate/camera_warnings.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/median.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

namespace facula {
namespace {

/// The views that take part, with their places in what was given.
struct Chosen {
  std::vector<BoardView> views;
  std::vector<std::size_t> index;

  void erase(std::size_t i) {
    views.erase(views.begin() + static_cast<std::ptrdiff_t>(i));
    index.erase(index.begin() + static_cast<std::ptrdiff_t>(i));
  }
};

std::string label(const BoardView& view, std::size_t index) {
  return view.name.empty() ? "view " + std::to_string(index) : "'" + view.name + "'";
}

Chosen found_views(const Board& board,
                   const std::vector<BoardView>& views,
                   std::vector<std::string>& rejected) {
  Chosen chosen;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const BoardView& view = views[i];
    if (!view.found()) {
      rejected.push_back(label(view, i) + ": " +
                         (view.failure.empty() ? "no points" : view.failure));
      continue;
    }
    require(
        view.ids.size() == view.pixels.size(), label(view, i), ": as many ids as pixels expected");
    for (std::size_t k = 0; k < view.ids.size(); ++k) {
      require(view.ids[k] >= 0 && static_cast<std::size_t>(view.ids[k]) < board.size() &&
                  view.pixels[k].allFinite(),
              label(view, i),
              ": point ",
              view.ids[k],
              " is not on the board or has no finite pixel");
    }
    if (view.ids.size() < 6) {
      rejected.push_back(label(view, i) + ": only " + std::to_string(view.ids.size()) +
                         " points, 6 are needed");
      continue;
    }
    chosen.views.push_back(view);
    chosen.index.push_back(i);
  }
  return chosen;
}

void check_views(const Chosen& chosen,
                 std::size_t given,
                 const std::vector<std::string>& rejected) {
  require(chosen.views.size() >= 3,
          "expected the board in 3 pictures or more, found it in ",
          chosen.views.size(),
          " of ",
          given,
          rejected.empty() ? "; take more pictures" : "; the first that failed: ",
          rejected.empty() ? "" : rejected.front());
  const BoardView& first = chosen.views.front();
  for (std::size_t i = 1; i < chosen.views.size(); ++i) {
    const BoardView& view = chosen.views[i];
    require(view.image_width == first.image_width && view.image_height == first.image_height,
            "expected pictures of one size, got ",
            first.image_width,
            " x ",
            first.image_height,
            " (",
            label(first, chosen.index[0]),
            ") and ",
            view.image_width,
            " x ",
            view.image_height,
            " (",
            label(view, chosen.index[i]),
            "); use one camera at one resolution, none of the pictures turned");
  }
}

void check_tilts(const CameraBundle& bundle) {
  const double spread = largest_turn_between_normals(bundle.poses);
  require(spread > 2 * std::numbers::pi / 180,
          "all ",
          bundle.poses.size(),
          " boards are parallel to each other to ",
          spread * 180 / std::numbers::pi,
          " degrees, which leaves focal length and distance open; tilt the board by 20 to 45 "
          "degrees in different directions");
}

BundleOptions bundle_options(const CameraCalibrationOptions& options) {
  return {.tangential = options.tangential,
          .radial_terms = options.radial_terms,
          .square_pixels = options.square_pixels};
}

bool usable(const std::optional<BundleResult>& fit) {
  if (!fit) return false;
  try {
    fit->bundle.camera.check();
  } catch (const Error&) {
    return false;
  }
  return true;
}

/// Terms that are not fitted stay as they start: at 0, whatever an earlier fit made of them.
CameraBundle without_held_terms(CameraBundle start, const BundleOptions& options) {
  Camera& camera = start.camera;
  if (options.radial_terms < 1) camera.k1 = 0;
  if (options.radial_terms < 2) camera.k2 = 0;
  if (options.radial_terms < 3) camera.k3 = 0;
  if (!options.tangential) camera.p1 = camera.p2 = 0;
  return start;
}

/// Fits with as many distortion terms as asked for, with fewer where these fold the image.
BundleResult fit_camera(const Board& board,
                        const std::vector<BoardView>& views,
                        const CameraBundle& start,
                        BundleOptions& options,
                        std::vector<std::string>& warnings) {
  // Focal length and poses first: all at once strays from a rough start.
  BundleOptions simple = options;
  simple.radial_terms = std::min(1, options.radial_terms);
  simple.tangential = false;
  const auto rough = fit_bundle(board, views, without_held_terms(start, simple), simple);
  const CameraBundle& from = rough ? rough->bundle : start;
  while (true) {
    auto fit = fit_bundle(board, views, without_held_terms(from, options), options);
    if (usable(fit)) return std::move(*fit);
    require(options.radial_terms > 0 || options.tangential,
            "the views do not determine a camera: the fit does not converge; show the board tilted "
            "in different directions and in all parts of the image");
    if (options.radial_terms > 1) {
      --options.radial_terms;
    } else {
      options.radial_terms = 0;
      options.tangential = false;
    }
    warnings.push_back("the views do not determine all terms of the distortion: fitted with " +
                       std::to_string(options.radial_terms) +
                       " radial terms instead; show the board in the corners of the image");
  }
}

/// The worst view when it is out of line with the others.
std::optional<std::size_t> bad_view(const BundleResult& fit, double limit) {
  std::vector<double> rms = fit.rms;
  if (rms.size() <= 3) return std::nullopt;
  const double most = limit > 0 ? limit : 3 * median(rms);
  const auto worst = std::max_element(fit.rms.begin(), fit.rms.end());
  if (*worst <= most) return std::nullopt;
  return static_cast<std::size_t>(worst - fit.rms.begin());
}

std::string rms_clause(const BoardView& view, std::size_t index, double rms) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.precision(3);
  text << label(view, index) << ": fits to " << rms
       << " px only; the board bent, moved or its points were mistaken";
  return text.str();
}

/// Sum of squares of a view whose camera comes from all the others.
CalibratedView held_out(const Board& board,
                        const Chosen& chosen,
                        const BundleResult& fit,
                        std::size_t v,
                        const BundleOptions& options) {
  Chosen others = chosen;
  others.erase(v);
  CameraBundle start = fit.bundle;
  start.poses.erase(start.poses.begin() + static_cast<std::ptrdiff_t>(v));
  CalibratedView view;
  view.view = chosen.index[v];
  view.camera_from_board = fit.bundle.poses[v];
  view.rms = fit.rms[v];
  view.points = chosen.views[v].ids.size();
  view.pose_covariance = fit.pose_covariance[v];
  view.tilt = std::acos(std::clamp(
      std::abs((view.camera_from_board.rotation * Eigen::Vector3d::UnitZ()).z()), 0.0, 1.0));
  const auto without = fit_bundle(board, others.views, start, options);
  view.held_out_rms = std::nan("");
  if (!without) return view;
  const CameraBundle alone{without->bundle.camera, {fit.bundle.poses[v]}};
  BundleOptions pose_only = options;
  pose_only.fixed_camera = true;
  const auto refit = fit_bundle(board, {chosen.views[v]}, alone, pose_only);
  if (refit) view.held_out_rms = refit->rms[0];
  return view;
}

void sum_up(CameraCalibration& result) {
  double squares = 0;
  double held_out_squares = 0;
  for (const CalibratedView& view : result.views) {
    const auto n = static_cast<double>(view.points);
    result.points += view.points;
    squares += n * view.rms * view.rms;
    held_out_squares += n * view.held_out_rms * view.held_out_rms;
  }
  result.rms = std::sqrt(squares / static_cast<double>(result.points));
  result.held_out_rms = std::sqrt(held_out_squares / static_cast<double>(result.points));
}

}  // namespace

void CameraCalibrationOptions::check() const {
  require(
      radial_terms >= 0 && radial_terms <= 3, "radial_terms: expected 0 to 3, got ", radial_terms);
  require(max_view_rms >= 0 && std::isfinite(max_view_rms),
          "max_view_rms_px: expected 0 or more, got ",
          max_view_rms);
}

CameraCalibration calibrate_camera(const Board& board,
                                   const std::vector<BoardView>& views,
                                   const CameraCalibrationOptions& options) {
  board.check();
  options.check();
  CameraCalibration result;
  Chosen chosen = found_views(board, views, result.rejected);
  check_views(chosen, views.size(), result.rejected);
  CameraBundle start = start_bundle(board, chosen.views);
  check_tilts(start);
  BundleOptions model = bundle_options(options);
  BundleResult fit = fit_camera(board, chosen.views, start, model, result.warnings);
  while (const auto bad = bad_view(fit, options.max_view_rms)) {
    result.rejected.push_back(rms_clause(chosen.views[*bad], chosen.index[*bad], fit.rms[*bad]));
    chosen.erase(*bad);
    start = fit.bundle;
    start.poses.erase(start.poses.begin() + static_cast<std::ptrdiff_t>(*bad));
    fit = fit_camera(board, chosen.views, start, model, result.warnings);
  }
  check_tilts(fit.bundle);
  result.camera = fit.bundle.camera;
  result.covariance = fit.camera_covariance;
  for (std::size_t v = 0; v < chosen.views.size(); ++v) {
    result.views.push_back(held_out(board, chosen, fit, v, model));
  }
  sum_up(result);
  add_camera_warnings(board, chosen.views, result);
  return result;
}

CalibratedView locate_board(const Board& board,
                            const BoardView& view,
                            const Camera& camera,
                            double inlier_distance) {
  board.check();
  require(inlier_distance > 0, "inlier_distance_px: expected above 0, got ", inlier_distance);
  require(view.found(),
          label(view, 0),
          ": no board to locate",
          view.failure.empty() ? "" : ", ",
          view.failure);
  auto located = locate_robustly(board, view, camera, inlier_distance);
  require(located.has_value(),
          label(view, 0),
          ": fewer than 4 of ",
          view.ids.size(),
          " points agree with one pose of the board to ",
          inlier_distance,
          " px; is this the camera and the board they were taken with?");
  const CameraBundle start{camera, {located->camera_from_board}};
  const auto fit = fit_bundle(board, {located->inliers}, start, {.fixed_camera = true});
  require(fit.has_value(), label(view, 0), ": the pose of the board does not converge");
  CalibratedView result;
  result.camera_from_board = fit->bundle.poses[0];
  result.rms = fit->rms[0];
  result.held_out_rms = fit->rms[0];
  result.points = located->inliers.ids.size();
  result.pose_covariance = fit->pose_covariance[0];
  result.tilt = std::acos(std::clamp(
      std::abs((result.camera_from_board.rotation * Eigen::Vector3d::UnitZ()).z()), 0.0, 1.0));
  return result;
}

}  // namespace facula
