// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/calibrate/camera_calibration.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/rig/covariance_block.hpp>
#include <facula/acquire/rig/rig_file.hpp>
#include <facula/acquire/rig/rig_parameters.hpp>
#include <facula/apps/cli/output_path.hpp>
#include <facula/apps/commands/board_pictures.hpp>
#include <facula/apps/commands/calibrate_camera.hpp>

#include <cmath>
#include <memory>

namespace facula {
namespace {

struct CameraArguments {
  std::vector<std::filesystem::path> pictures;
  BoardArguments board;
  std::filesystem::path rig;
  std::filesystem::path out;
  CameraCalibrationOptions options;
  bool no_tangential = false;
};

void declare(Arguments& arguments, CameraArguments& a) {
  arguments.inputs("PICTURES", a.pictures, "pictures of the board, tilted and all over the image");
  arguments.required();
  declare_board(arguments, a.board);
  arguments.output("--out", a.out, "the rig that is written (.toml)");
  arguments.required();
  arguments.input("--rig", a.rig, "a rig whose other parts are kept");
  arguments.whole("--radial-terms", a.options.radial_terms, "how many of k1, k2, k3 to estimate");
  arguments.flag("--no-tangential", a.no_tangential, "take p1 and p2 as 0");
  arguments.flag("--square-pixels", a.options.square_pixels, "take fx and fy as equal");
  arguments.number("--max-view-rms-px",
                   a.options.max_view_rms,
                   kPixels,
                   "leave out views that fit worse, 0 = 3 times the median");
}

void report_parameters(const CameraCalibration& result, Figures& figures) {
  const Camera& c = result.camera;
  const std::vector<double> values = {c.fx, c.fy, c.cx, c.cy, c.k1, c.k2, c.p1, c.p2, c.k3};
  const std::vector<std::string> names = camera_parameter_names();
  FigureTable table{"parameters",
                    "Camera:",
                    {{"parameter", "parameter", 0}, {"value", "value", 5}, {"sigma", "sigma", 5}},
                    {}};
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    table.rows.push_back({names[i], values[i], std::sqrt(result.covariance(k, k))});
  }
  figures.table(std::move(table));
}

void report_views(const std::vector<BoardView>& views,
                  const CameraCalibration& result,
                  Figures& figures) {
  FigureTable table{"views",
                    "Views (rms of point distances; held out: camera from the other views):",
                    {{"view", "view", 0},
                     {"points", "points", 0},
                     {"rms_px", "rms", 3},
                     {"held_out_rms_px", "held out", 3},
                     {"tilt_deg", "tilt", 1},
                     {"distance_mm", "distance", 0},
                     {"edge_width_px", "edge width", 1}},
                    {}};
  for (const CalibratedView& view : result.views) {
    table.rows.push_back({views[view.view].name,
                          static_cast<long long>(view.points),
                          view.rms,
                          view.held_out_rms,
                          view.tilt / kDegrees.factor,
                          1000 * view.camera_from_board.translation.norm(),
                          views[view.view].sharpness});
  }
  figures.table(std::move(table));
}

void run(const CameraArguments& a, Session& session) {
  check_output(a.out, {".toml"});
  const Board board = board_of(a.board);
  CameraCalibrationOptions options = a.options;
  options.tangential = !a.no_tangential;
  require(
      a.options.radial_terms <= 3, "--radial-terms: expected 0 to 3, got ", a.options.radial_terms);
  options.check();
  Rig rig;
  if (!a.rig.empty()) rig = read_rig(a.rig, RigParts::kCamera);
  session.step("looking for the board", 1, 2);
  const std::vector<BoardView> views = find_boards(a.pictures, board, session);
  session.step("calibrating", 2, 2);
  const CameraCalibration result = calibrate_camera(board, views, options);
  session.end_steps();
  rig.camera = result.camera;
  replace_covariance(rig, "camera.", camera_parameter_names(), result.covariance);
  write_rig(a.out, rig, RigParts::kCamera);

  Figures& figures = session.figures;
  report_boards(views, figures);
  figures.count("views_used", "views used", result.views.size());
  figures.count("points", "points", result.points);
  figures.number("rms_px", "rms", result.rms, 4);
  figures.number("held_out_rms_px", "rms of views left out", result.held_out_rms, 4);
  report_parameters(result, figures);
  report_views(views, result, figures);
  for (const std::string& clause : result.rejected) figures.note("Left out: " + clause + ".");
  for (const std::string& clause : result.warnings) figures.note("Warning: " + clause + ".");
  figures.text("out", "written", a.out.string());
}

}  // namespace

Command calibrate_camera_command() {
  const auto a = std::make_shared<CameraArguments>();
  return {.name = "calibrate camera",
          .summary = "a camera from pictures of a board",
          .description =
              "Finds a chessboard, a grid of circles or a ChArUco board in pictures and estimates "
              "focal length, principal point and distortion with their uncertainty (Zhang 2000). "
              "Says why a picture was left out and what the pictures cannot decide. The figure to "
              "trust is the rms of views left out of the fit.",
          .examples = {"facula calibrate board --rig data/rigs/ciclop_turntable.toml --cols 9 "
                       "--rows 6 --spacing-mm 12 --views 6 --out boards",
                       "facula calibrate camera boards/dark_0.png boards/dark_1.png "
                       "boards/dark_2.png boards/dark_3.png boards/dark_4.png boards/dark_5.png "
                       "--cols 9 --rows 6 --spacing-mm 12 --out rig.toml"},
          .declare = [a](Arguments& arguments) { declare(arguments, *a); },
          .run = [a](Session& session) { run(*a, session); }};
}

}  // namespace facula
