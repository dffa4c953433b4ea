// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/calibrate/render_board.hpp>
#include <facula/acquire/capture/frame_source.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/rig/rig_file.hpp>
#include <facula/apps/cli/output_path.hpp>
#include <facula/apps/commands/board_pictures.hpp>
#include <facula/apps/commands/calibrate_board.hpp>

#include <cmath>
#include <memory>
#include <numbers>

namespace facula {
namespace {

struct BoardPictureArguments {
  std::filesystem::path rig;
  std::filesystem::path out;
  BoardArguments board;
  int views = 10;
  double nearest = 0;   ///< 0 = so that the board fills most of the image [m]
  double farthest = 0;  ///< 0 = 1.5 times the nearest [m]
  double tilt = 30 * kDegrees.factor;
  bool lit = false;
  bool overwrite = false;
  std::size_t seed = 1;
  RenderBoardOptions options;
};

void declare(Arguments& arguments, BoardPictureArguments& a) {
  arguments.input("--rig", a.rig, "the camera and its sheets of light");
  arguments.required();
  declare_board(arguments, a.board);
  arguments.output("--out", a.out, "folder of the pictures that is made");
  arguments.required();
  arguments.flag("--overwrite", a.overwrite, "replace earlier pictures in that folder");
  arguments.whole("--views", a.views, "how many places of the board");
  arguments.number("--nearest-mm",
                   a.nearest,
                   kMillimetres,
                   "least distance of the board, 0 = where it fills two thirds of the image");
  arguments.number(
      "--farthest-mm", a.farthest, kMillimetres, "greatest distance, 0 = 1.5 times the least");
  arguments.number("--tilt-deg", a.tilt, kDegrees, "how far the board is tilted");
  arguments.flag("--lit", a.lit, "also take each picture with the lasers on (lit_...)");
  arguments.number("--noise-dn", a.options.noise, kGreyLevels, "of a pixel, standard deviation");
  arguments.number("--blur-px", a.options.blur, kPixels, "of the lens, standard deviation");
  arguments.whole("--seed", a.seed, "of the noise");
}

/// Place i of n: the tilt goes round in golden angles, the distance from near to far, the middle of
/// the board from part to part of the image.
RigidTransform place(const BoardPictureArguments& a,
                     const Board& board,
                     const Camera& camera,
                     int i) {
  const auto corners = board.outline(1);
  const Eigen::Vector3d middle = 0.5 * (corners[0] + corners[2]);
  const Eigen::Vector3d size = corners[2] - corners[0];
  const double fills =
      std::max(size.x() * camera.fx / camera.width, size.y() * camera.fy / camera.height);
  const double nearest = a.nearest > 0 ? a.nearest : 1.5 * fills;
  const double farthest = a.farthest > 0 ? a.farthest : 1.5 * nearest;
  const double share = a.views > 1 ? static_cast<double>(i) / (a.views - 1) : 0;
  const double distance = nearest + (farthest - nearest) * share;
  const double turn = i * std::numbers::pi * (3 - std::sqrt(5.0));
  const Eigen::Vector3d axis(std::cos(turn), std::sin(turn), 0);
  const double room = std::max(0.0, 0.9 - fills / distance) / 2;
  const Eigen::Vector2d pixel(camera.cx + room * camera.width * std::cos(2.4 * turn + 1),
                              camera.cy + room * camera.height * std::sin(1.7 * turn + 1));
  const Eigen::Vector3d centre(distance * (pixel.x() - camera.cx) / camera.fx,
                               distance * (pixel.y() - camera.cy) / camera.fy,
                               distance);
  RigidTransform pose;
  pose.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(a.tilt, axis));
  pose.translation = centre - pose.rotation * middle;
  return pose;
}

void run(const BoardPictureArguments& a, Session& session) {
  const Board board = board_of(a.board);
  const Rig rig = read_rig(a.rig, RigParts::kCamera);
  require(a.views >= 1 && a.views <= 1000, "--views: expected 1 to 1000, got ", a.views);
  require(
      std::abs(a.tilt) < 1.3, "--tilt-deg: expected less than 75, got ", a.tilt / kDegrees.factor);
  require(!a.lit || !rig.lasers.empty(),
          "--lit: rig '",
          rig.name,
          "' has no [[laser]]; calibrate one or name another rig");
  a.options.check();
  OutputFolder folder(a.out, "dark_0.png", a.overwrite);
  for (int i = 0; i < a.views; ++i) {
    session.step("rendering", static_cast<std::size_t>(i) + 1, static_cast<std::size_t>(a.views));
    const RigidTransform pose = place(a, board, rig.camera, i);
    RenderBoardOptions options = a.options;
    options.num_threads = session.num_threads;
    options.seed = 2 * (a.seed * 1000 + static_cast<std::size_t>(i));
    const std::string name = std::to_string(i) + ".png";
    write_image(folder.temporary_path() / ("dark_" + name),
                render_board(board, rig.camera, pose, {}, options).view());
    if (!a.lit) continue;
    ++options.seed;
    write_image(folder.temporary_path() / ("lit_" + name),
                render_board(board, rig.camera, pose, rig.lasers, options).view());
  }
  session.end_steps();
  folder.commit();
  session.figures.text("out", "pictures", a.out.string());
  session.figures.count("views", "places of the board", static_cast<std::size_t>(a.views));
}

}  // namespace

Command calibrate_board_command() {
  const auto a = std::make_shared<BoardPictureArguments>();
  return {.name = "calibrate board",
          .summary = "pictures of a board as a rig's camera would take them",
          .description =
              "Renders a chessboard, a grid of circles or a ChArUco board in several places before "
              "the camera of a rig, laser off (dark_0.png ...) and on (lit_0.png ...): to see "
              "before the real thing how well a rig, a board and a number of pictures calibrate.",
          .examples = {"facula calibrate board --rig data/rigs/ciclop_turntable.toml --board "
                       "charuco --cols 7 --rows 5 --spacing-mm 15 --views 3 --lit --out charuco"},
          .declare = [a](Arguments& arguments) { declare(arguments, *a); },
          .run = [a](Session& session) { run(*a, session); }};
}

}  // namespace facula
