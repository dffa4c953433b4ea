// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/capture/capture_file.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/scan_file.hpp>
#include <facula/acquire/rig/rig_file.hpp>
#include <facula/acquire/triangulate/extract_log.hpp>
#include <facula/apps/cli/file_kind.hpp>
#include <facula/apps/cli/output_path.hpp>
#include <facula/apps/commands/extract.hpp>
#include <facula/apps/commands/log_figures.hpp>

#include <algorithm>
#include <cmath>
#include <memory>

namespace facula {
namespace {

struct ExtractArguments {
  std::filesystem::path capture;
  std::filesystem::path frames;
  std::filesystem::path rig;
  std::filesystem::path log;
  bool resume = false;
  std::vector<std::filesystem::path> out;
  std::string detector;
  bool median_of_three = false;
  std::string channel;
  std::optional<double> sigma;    ///< [px]
  std::optional<double> min_snr;  ///< [1]
};

void declare(Arguments& arguments, ExtractArguments& a) {
  arguments.input("CAPTURE", a.capture, "a capture folder, its capture.toml, or a stripe log");
  arguments.required();
  arguments.outputs(
      "--out", a.out, "the scan: .pcd keeps everything, .ply and .asc the points that are there");
  arguments.required();
  arguments.input("--frames", a.frames, "folder where the frames lie, if not beside the capture");
  arguments.output("--log", a.log, "stripe log to write on the way: the scan can be made from it");
  arguments.flag("--resume", a.resume, "go on with that log: read only the frames it lacks");
  arguments.input("--rig", a.rig, "a newer calibration, instead of what capture or log say");
  arguments.choice("--detector",
                   a.detector,
                   detector_names(),
                   "how the line is found, instead of what the capture says");
  arguments.flag("--median-of-three",
                 a.median_of_three,
                 "make each position the median of three rows, against speckle");
  arguments.choice(
      "--channel",
      a.channel,
      {"grey", "red", "green", "blue", "red-excess", "green-excess", "blue-excess", "maximum"},
      "what of a colour pixel counts, instead of what the capture says");
  arguments.number("--sigma-px", a.sigma, kPixels, "expected width of the line, 1 sigma");
  arguments.number("--min-snr", a.min_snr, kPlainNumber, "least height of the line over the noise");
}

void apply_overrides(const ExtractArguments& a, StripeOptions& stripe) {
  if (!a.detector.empty()) stripe.detector = detector_from_name(a.detector);
  if (a.median_of_three) stripe.median_rows = 3;
  if (!a.channel.empty()) stripe.channel = channel_from_name(a.channel);
  if (a.sigma) stripe.sigma = *a.sigma;
  if (a.min_snr) stripe.min_snr = *a.min_snr;
  stripe.check();
}

double percent(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

void report_zero_line(const std::vector<double>& shifts, Figures& figures) {
  if (shifts.empty()) return;
  const auto [least, most] = std::minmax_element(shifts.begin(), shifts.end());
  double sum = 0;
  for (const double shift : shifts) sum += shift;
  figures.number(
      "zero_line_shift_mean_px", "zero line, mean shift", sum / double(shifts.size()), 3);
  figures.number("zero_line_shift_min_px", "zero line, least shift", *least, 3);
  figures.number("zero_line_shift_max_px", "zero line, largest shift", *most, 3);
}

void report(const ExtractResult& result, Figures& figures) {
  figures.count("frames", "frames", result.frames);
  figures.count("rows", "rows of the scan", static_cast<std::size_t>(result.scan.rows));
  figures.count("points", "points", result.scan.valid_count());
  figures.number("stripes_seen_percent",
                 "rows with a stripe",
                 percent(result.stripes_seen, result.rows_searched),
                 1);
  figures.number("outside_percent",
                 "stripes outside the volume",
                 percent(result.outside_volume, result.stripes_seen),
                 1);
  figures.number(
      "saturated_percent", "stripes saturated", percent(result.saturated, result.stripes_seen), 1);
  figures.number("stripe_sigma_px", "stripe sigma, median", result.median_pixel_sigma, 3);
  figures.number("stripe_width_px", "stripe width, median", result.median_width, 2);
  figures.number("noise_dn", "image noise, median", result.median_noise, 2);
  figures.number("point_sigma_mm", "point sigma, median", 1000 * result.median_point_sigma, 3);
  figures.number(
      "stripe_share_mm", "  of it the stripe's share", 1000 * result.median_stripe_sigma, 3);
  if (result.median_calibration_sigma) {
    figures.number("calibration_share_mm",
                   "  of it the calibration's share",
                   1000 * *result.median_calibration_sigma,
                   3);
  } else {
    figures.note(
        "The rig has no [covariance]: the sigmas hold the stripe's share only, not the "
        "calibration's.");
  }
  report_zero_line(result.zero_line_shift, figures);
  if (result.log) report_log(*result.log, figures);
}

void require_stripes(const ExtractResult& result) {
  require(result.stripes_seen > 0,
          "expected the laser line in the frames, got none in ",
          result.frames,
          " of them; check that the laser was on and shone into the capture's [volume], if it has "
          "one, then try another --channel, the width of the line as --sigma-px or a lower "
          "--min-snr");
  require(result.scan.valid_count() > 0,
          "expected points within the capture's volume, got none of ",
          result.stripes_seen,
          " rows with a stripe; check [volume] of the capture and the rig");
}

ExtractResult extract_from_capture(const ExtractArguments& a, const Session& session) {
  require(!a.resume || !a.log.empty(), "--resume needs the log to go on with; name it with --log");
  const auto frames = a.frames.empty() ? std::nullopt : std::optional(a.frames);
  Capture capture = read_capture(a.capture, frames);
  if (!a.rig.empty()) capture = with_rig(std::move(capture), a.rig);
  apply_overrides(a, capture.stripe);
  return extract_scan(capture,
                      {.num_threads = session.num_threads,
                       .progress = session.progress("reading stripes"),
                       .log = a.log,
                       .resume = a.resume});
}

ExtractResult extract_from_log(const ExtractArguments& a, const Session& session) {
  require(a.log.empty() && !a.resume && a.frames.empty(),
          "'",
          a.capture.string(),
          "' is a stripe log, which is read and not written; leave out --log, --resume and "
          "--frames");
  const StripeLogReader log(a.capture);
  Capture capture = log.settings();
  if (!a.rig.empty()) capture = with_rig(std::move(capture), a.rig);
  apply_overrides(a, capture.stripe);
  return extract_scan(
      log,
      capture,
      {.num_threads = session.num_threads, .progress = session.progress("reading the log")});
}

bool is_same_place(const std::filesystem::path& a, const std::filesystem::path& b) {
  namespace fs = std::filesystem;
  return fs::weakly_canonical(fs::absolute(a)) == fs::weakly_canonical(fs::absolute(b));
}

/// A scan written under the log's name would take the place of the recording.
void check_outputs(const ExtractArguments& a) {
  for (const auto& path : a.out) {
    check_output(path, {".pcd", ".ply", ".asc"});
    require(a.log.empty() || !is_same_place(path, a.log),
            "expected --log and --out to name two files, got '",
            path.string(),
            "' for both, where the scan would replace the log; give the log another name");
  }
}

void run(const ExtractArguments& a, Session& session) {
  check_outputs(a);
  const bool from_log = file_kind(a.capture) == FileKind::kLog;
  const ExtractResult result =
      from_log ? extract_from_log(a, session) : extract_from_capture(a, session);
  require_stripes(result);
  for (const auto& path : a.out) write_scan(path, result.scan);
  report(result, session.figures);
  for (std::size_t i = 0; i < a.out.size(); ++i) {
    session.figures.text("out_" + std::to_string(i + 1), "written", a.out[i].string());
  }
}

constexpr const char* kMakeRoom =
    "facula simulate data/scenes/furnished_room.toml --rig data/rigs/head_fs1500.toml --from-deg 0 "
    "--to-deg 10 --step-deg 1 --position-mm -1500 -300 1100 --out room";

}  // namespace

Command extract_command() {
  const auto a = std::make_shared<ExtractArguments>();
  return {.name = "extract",
          .summary = "find the laser line in frames and make a scan",
          .description =
              "Finds the laser line in every frame of a capture to a fraction of a pixel, meets "
              "each ray with the laser plane, turns the points by the axis, and writes a polar "
              "scan with a standard deviation per point. With --log everything about the line goes "
              "to one small file as it is found, frame by frame, from which the same scan can be "
              "made again, or a better one with a newer rig or another detector.",
          .examples = {kMakeRoom,
                       "facula extract room --out room.pcd --out room.ply",
                       "facula extract room --detector centroid --min-snr 8 --out centroid.pcd",
                       "facula extract room --detector steger --median-of-three --out quiet.pcd",
                       "facula extract room --log room.flog --out logged.pcd",
                       "facula extract room --log room.flog --resume --out resumed.pcd",
                       "facula extract room.flog --rig room/rig.toml --out again.pcd"},
          .declare = [a](Arguments& arguments) { declare(arguments, *a); },
          .run = [a](Session& session) { run(*a, session); }};
}

}  // namespace facula
