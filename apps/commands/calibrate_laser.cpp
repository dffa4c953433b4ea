// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/calibrate/camera_calibration.hpp>
#include <facula/acquire/calibrate/laser_calibration.hpp>
#include <facula/acquire/capture/frame_source.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/acquire/rig/covariance_block.hpp>
#include <facula/acquire/rig/rig_file.hpp>
#include <facula/apps/cli/output_path.hpp>
#include <facula/apps/commands/board_pictures.hpp>
#include <facula/apps/commands/calibrate_laser.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>

namespace facula {
namespace {

constexpr double kAsGood = 1.5;  // times the least error of views left out

struct LaserArguments {
  std::vector<std::filesystem::path> pictures;
  std::vector<std::filesystem::path> dark;
  BoardArguments board;
  std::filesystem::path rig;
  std::filesystem::path out;
  std::string laser = "laser";
  std::string stripe;
  std::string channel = "auto";
  double sigma = 2;  ///< [px]
  bool bow = false;
};

/// What one picture gives besides its lines.
struct LaserPicture {
  std::string name;
  Image8 lit;
  Image8 dark;
  std::string failure;
  BoardPose pose;
};

/// The lines as one channel shows them, and the sheet through them.
struct Attempt {
  Channel channel = Channel::kRedExcess;
  std::vector<LaserLineView> lines;
  LaserCalibration fit;
};

void declare(Arguments& arguments, LaserArguments& a) {
  arguments.inputs("PICTURES", a.pictures, "pictures of the board with the line across it");
  arguments.required();
  arguments.input("--rig", a.rig, "the rig with the calibrated camera; other parts are kept");
  arguments.required();
  declare_board(arguments, a.board);
  arguments.output("--out", a.out, "the rig that is written (.toml)");
  arguments.required();
  arguments.inputs("--dark", a.dark, "the same views without the laser, in the same order");
  arguments.word("--laser", a.laser, "name of the sheet in the rig");
  arguments.choice("--stripe", a.stripe, {"upright", "level"}, "which way the line runs");
  arguments.choice("--channel",
                   a.channel,
                   {"auto",
                    "red-excess",
                    "green-excess",
                    "blue-excess",
                    "grey",
                    "red",
                    "green",
                    "blue",
                    "maximum"},
                   "what the line is found in; auto: tries them, keeps the flattest sheet");
  arguments.number("--sigma-px", a.sigma, kPixels, "width of the line, standard deviation");
  arguments.flag("--bow", a.bow, "also estimate how far the sheet is a cone");
}

LaserPicture read_picture(const LaserArguments& a,
                          std::size_t i,
                          const Board& board,
                          const Camera& camera) {
  LaserPicture picture;
  picture.name = a.pictures[i].filename().string();
  picture.lit = read_image(a.pictures[i]);
  if (!a.dark.empty()) picture.dark = read_image(a.dark[i]);
  const Image8& shows_board = picture.dark.empty() ? picture.lit : picture.dark;
  require(shows_board.cols == camera.width && shows_board.rows == camera.height,
          "'",
          picture.name,
          "': expected ",
          camera.width,
          " x ",
          camera.height,
          " px as the rig's camera has, got ",
          shows_board.cols,
          " x ",
          shows_board.rows);
  const BoardView view = find_board(shows_board.view(), board, picture.name);
  picture.failure = view.failure;
  if (!view.found()) return picture;
  const CalibratedView located = locate_board(board, view, camera);
  picture.pose.camera_from_board = located.camera_from_board;
  // Turns about x and y and the shift along z: numbers 0, 1 and 5 of the six.
  picture.pose.plane_covariance = located.pose_covariance(std::array{0, 1, 5}, std::array{0, 1, 5});
  return picture;
}

std::vector<LaserPicture> read_pictures(const LaserArguments& a,
                                        const Board& board,
                                        const Camera& camera,
                                        Session& session) {
  std::vector<LaserPicture> pictures(a.pictures.size());
  parallel_for(pictures.size(),
               [&](std::size_t begin, std::size_t end) {
                 for (std::size_t i = begin; i < end; ++i)
                   pictures[i] = read_picture(a, i, board, camera);
               },
               {.num_threads = session.num_threads, .chunk = 1});
  return pictures;
}

Attempt attempt(const std::vector<LaserPicture>& pictures,
                const Board& board,
                const Camera& camera,
                const BoardLineOptions& options,
                bool bow) {
  Attempt made;
  made.channel = options.stripe.channel;
  std::vector<BoardPose> poses;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const LaserPicture& picture = pictures[i];
    poses.push_back(picture.pose);
    LaserLineView line;
    line.failure = "the board was not found: " + picture.failure;
    if (picture.failure.empty()) {
      line = find_line_on_board(picture.lit.view(),
                                picture.dark.empty() ? ImageView8() : picture.dark.view(),
                                board,
                                camera,
                                picture.pose.camera_from_board,
                                options);
    }
    line.view = i;
    made.lines.push_back(std::move(line));
  }
  made.fit = calibrate_laser(camera, poses, made.lines, 0, {.bow = bow});
  return made;
}

/// The best first. A channel that sees the line in few views must not win, nor one that takes the
/// board's print for the line in many: so of those with half as many views as any has, and of these
/// those that miss the views left out by little more than the best of them, the one with most
/// views.
void best_first(std::vector<Attempt>& made) {
  std::size_t most = 0;
  for (const Attempt& one : made) most = std::max(most, one.fit.views.size());
  const auto seen = [&](const Attempt& one) { return 2 * one.fit.views.size() >= most; };
  double least = std::numeric_limits<double>::infinity();
  for (const Attempt& one : made) {
    if (seen(one)) least = std::min(least, one.fit.held_out_rms);
  }
  const auto worth = [&](const Attempt& one) {
    const bool good = seen(one) && one.fit.held_out_rms <= kAsGood * least;
    return std::tuple(good, good ? one.fit.views.size() : 0, -one.fit.held_out_rms);
  };
  std::stable_sort(made.begin(), made.end(), [&](const Attempt& x, const Attempt& y) {
    return worth(x) > worth(y);
  });
}

/// All channels asked for, the one to take first.
std::vector<Attempt> attempts(const LaserArguments& a,
                              const std::vector<LaserPicture>& pictures,
                              const Board& board,
                              const Rig& rig) {
  std::vector<Channel> channels = {
      Channel::kRedExcess, Channel::kGreenExcess, Channel::kGreen, Channel::kGrey, Channel::kRed};
  if (a.channel != "auto") channels = {channel_from_name(a.channel)};
  BoardLineOptions options;
  options.stripe.direction = rig.stripe_direction;
  options.stripe.sigma = a.sigma;
  std::vector<Attempt> made;
  std::optional<Error> failure;
  for (const Channel channel : channels) {
    options.stripe.channel = channel;
    try {
      made.push_back(attempt(pictures, board, rig.camera, options, a.bow));
    } catch (const Error& error) {
      if (!failure) failure = error;
    }
  }
  if (made.empty()) throw Error(*failure);
  best_first(made);
  return made;
}

void report_channels(const std::vector<Attempt>& made, Figures& figures) {
  FigureTable table{"channels",
                    "Channels, the one taken first:",
                    {{"channel", "channel", 0},
                     {"views", "views", 0},
                     {"points", "points", 0},
                     {"held_out_rms_mm", "held out", 3}},
                    {}};
  for (const Attempt& one : made) {
    table.rows.push_back({to_string(one.channel),
                          static_cast<long long>(one.fit.views.size()),
                          static_cast<long long>(one.fit.points),
                          1000 * one.fit.held_out_rms});
  }
  figures.table(std::move(table));
}

void report_sheet(const LaserCalibration& fit, Figures& figures) {
  const auto sigma = [&](Eigen::Index i) { return std::sqrt(fit.covariance(i, i)); };
  const Eigen::Vector3d& n = fit.plane.normal;
  figures.numbers("normal", "normal", {n.x(), n.y(), n.z()}, 6);
  figures.number("distance_mm", "distance from the camera", 1000 * fit.plane.distance, 3);
  figures.number("normal_sigma_deg",
                 "sigma of the normal",
                 std::hypot(sigma(0), sigma(1)) / kDegrees.factor,
                 4);
  figures.number("distance_sigma_mm", "sigma of the distance", sigma(2), 3);
  if (fit.covariance.rows() > 3) {
    figures.number("bow_deg", "bow", fit.plane.bow / kDegrees.factor, 4);
    figures.number("bow_sigma_deg", "sigma of the bow", sigma(3) / kDegrees.factor, 4);
  }
  figures.count("points", "points", fit.points);
  figures.number("rms_mm", "rms over all points", 1000 * fit.rms, 4);
  figures.number("held_out_rms_mm", "rms of views left out", 1000 * fit.held_out_rms, 4);
  figures.number("outlier_percent", "points that count as outliers", 100 * fit.outlier_share, 2);
}

void report_views(const std::vector<LaserPicture>& pictures,
                  const Attempt& best,
                  Figures& figures) {
  FigureTable table{"views",
                    "Views (off the sheet, all points; held out: sheet from the other views):",
                    {{"view", "view", 0},
                     {"points", "points", 0},
                     {"rms_mm", "rms", 3},
                     {"mean_mm", "mean", 3},
                     {"held_out_rms_mm", "held out", 3}},
                    {}};
  for (const LaserViewResidual& view : best.fit.views) {
    table.rows.push_back({pictures[view.view].name,
                          static_cast<long long>(view.points),
                          1000 * view.rms,
                          1000 * view.mean,
                          1000 * view.held_out_rms});
  }
  figures.table(std::move(table));
  for (const LaserLineView& line : best.lines) {
    if (!line.failure.empty()) {
      figures.note("Left out: '" + pictures[line.view].name + "': " + line.failure + ".");
    }
  }
}

/// Puts the sheet in the place of the one of that name, or adds it.
void put_sheet(Rig& rig, const std::string& name, const LaserCalibration& fit) {
  LaserPlane plane = fit.plane;
  plane.name = name;
  const auto same = std::find_if(
      rig.lasers.begin(), rig.lasers.end(), [&](const LaserPlane& l) { return l.name == name; });
  if (same != rig.lasers.end()) {
    *same = plane;
  } else {
    rig.lasers.push_back(plane);
  }
  const std::string part = "laser." + name + ".";
  std::vector<std::string> names = {part + "turn_a_rad", part + "turn_b_rad", part + "distance_mm"};
  if (fit.covariance.rows() > 3) names.push_back(part + "bow_rad");
  replace_covariance(rig, part, names, fit.covariance);
}

void run(const LaserArguments& a, Session& session) {
  check_output(a.out, {".toml"});
  const Board board = board_of(a.board);
  Rig rig = read_rig(a.rig, RigParts::kCamera);
  if (!a.stripe.empty()) {
    rig.stripe_direction =
        a.stripe == "level" ? StripeDirection::kPerColumn : StripeDirection::kPerRow;
  }
  require(a.dark.empty() || a.dark.size() == a.pictures.size(),
          "expected one picture without the laser for each of ",
          a.pictures.size(),
          " with it, got ",
          a.dark.size(),
          "; give them in the same order");
  session.step("looking for the board", 1, 2);
  const auto pictures = read_pictures(a, board, rig.camera, session);
  session.step("looking for the line", 2, 2);
  const std::vector<Attempt> made = attempts(a, pictures, board, rig);
  session.end_steps();
  const Attempt& best = made.front();
  put_sheet(rig, a.laser, best.fit);
  write_rig(a.out, rig);

  Figures& figures = session.figures;
  figures.count("pictures", "pictures", pictures.size());
  figures.count("views_used", "views used", best.fit.views.size());
  figures.text("channel", "channel", to_string(best.channel));
  report_sheet(best.fit, figures);
  report_views(pictures, best, figures);
  if (made.size() > 1) report_channels(made, figures);
  for (const std::string& clause : best.fit.warnings) figures.note("Warning: " + clause + ".");
  figures.text("out", "written", a.out.string());
}

}  // namespace

Command calibrate_laser_command() {
  const auto a = std::make_shared<LaserArguments>();
  return {.name = "calibrate laser",
          .summary = "a sheet of light from pictures of a board with the line on it",
          .description =
              "Finds the board and the laser line on it in each picture, carries the line onto the "
              "board and fits the sheet of light through all of it. Hold the board at several "
              "distances. Pictures without the laser (--dark) sharpen the line on printed paper. "
              "The figure to trust is the rms of views left out of the fit.",
          .examples = {"facula calibrate board --rig data/rigs/ciclop_turntable.toml --cols 9 "
                       "--rows 6 --spacing-mm 12 --views 4 --lit --out boards",
                       "facula calibrate laser boards/lit_0.png boards/lit_1.png boards/lit_2.png "
                       "boards/lit_3.png --dark boards/dark_0.png --dark boards/dark_1.png --dark "
                       "boards/dark_2.png --dark boards/dark_3.png --rig "
                       "data/rigs/ciclop_turntable.toml --cols 9 --rows 6 --spacing-mm 12 --laser "
                       "right --out rig.toml"},
          .declare = [a](Arguments& arguments) { declare(arguments, *a); },
          .run = [a](Session& session) { run(*a, session); }};
}

}  // namespace facula
