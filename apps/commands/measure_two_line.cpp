// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/capture/frame_source.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/rig/rig_file.hpp>
#include <facula/acquire/two_line/two_line_frame.hpp>
#include <facula/apps/commands/measure_two_line.hpp>
#include <facula/apps/commands/wall_table.hpp>

#include <cmath>
#include <memory>

namespace facula {
namespace {

struct FrameArguments {
  std::filesystem::path frame;
  std::filesystem::path background;
  std::filesystem::path rig;
  std::string method = "stripes";
  std::optional<double> spacing;       ///< [m]
  std::optional<double> medium_index;  ///< [1]
  TwoLineOptions options;
  WallStripe stripe{.channel = "green-excess", .sigma = 2};
};

void declare(Arguments& arguments, FrameArguments& a) {
  arguments.input("FRAME", a.frame, "a picture of the two lines");
  arguments.required();
  arguments.input("--rig", a.rig, "the rig, with its two-line head (rig.toml)");
  arguments.required();
  arguments.input("--background", a.background, "the same view without the lines");
  arguments.choice("--method",
                   a.method,
                   {"stripes", "hough"},
                   "sub-pixel stripes, or edges and Hough lines as the source has it");
  arguments.number(
      "--spacing-mm", a.spacing, kMillimetres, "between the sheets, instead of what the rig says");
  arguments.number(
      "--medium-index", a.medium_index, kPlainNumber, "instead of what the rig says; water 1.33");
  arguments.whole("--segments", a.options.segments, "side by side about the middle");
  arguments.whole("--segment-px", a.options.segment_width, "width of a segment in pixels");
  arguments.number(
      "--threshold-dn",
      a.options.threshold,
      kGreyLevels,
      "of the grey picture, for hough; 0 = half way from the background to the brightest");
  arguments.number("--merge-px",
                   a.options.merge_distance,
                   kPixels,
                   "Hough segments closer than this are one line");
  declare_wall_stripe(arguments, a.stripe);
}

/// Rows whose reading failed come last, so that the columns of numbers stay columns of numbers.
void report(const std::vector<TwoLineReading>& readings, Figures& figures) {
  FigureTable table{"segments",
                    "Segments:",
                    {{"angle_deg", "angle", 2},
                     {"upper_px", "upper line", 3},
                     {"lower_px", "lower line", 3},
                     {"depth_mm", "depth", 2},
                     {"range_mm", "range", 2},
                     {"sigma_mm", "1 sigma", 2}},
                    {}};
  std::size_t good = 0;
  for (const TwoLineReading& r : readings) {
    if (!r.depth) {
      figures.note("segment at " + std::to_string(std::lround(r.angle / kDegrees.factor)) +
                   " deg: " + r.failure);
      continue;
    }
    ++good;
    table.rows.push_back({r.angle / kDegrees.factor,
                          r.upper_px,
                          r.lower_px,
                          1000 * *r.depth,
                          1000 * *r.depth / std::cos(r.angle),
                          1000 * r.sigma});
  }
  figures.count("segment_count", "segments", readings.size());
  figures.count("segments_measured", "measured", good);
  figures.table(std::move(table));
}

void run(const FrameArguments& a, Session& session) {
  Rig rig = read_rig(a.rig);
  if (a.spacing || a.medium_index) {
    TwoLineHead head = rig.two_line.value_or(TwoLineHead{});
    head.spacing = a.spacing.value_or(head.spacing);
    head.medium_index = a.medium_index.value_or(head.medium_index);
    head.check();
    rig.two_line = head;
  }
  TwoLineOptions options = a.options;
  options.method = a.method == "hough" ? TwoLineMethod::kHough : TwoLineMethod::kStripes;
  options.stripe.channel = channel_from_name(a.stripe.channel);
  options.stripe.sigma = a.stripe.sigma;
  const Image8 frame = read_image(a.frame);
  Image8 background;
  if (!a.background.empty()) background = read_image(a.background);
  report(read_two_lines(frame.view(), background.view(), rig, options), session.figures);
}

}  // namespace

Command measure_two_line_command() {
  const auto a = std::make_shared<FrameArguments>();
  return {
      .name = "measure two-line",
      .summary = "distances from a picture of two parallel lines",
      .description =
          "Reads a picture of a two-line head: in every segment the rows of the two lines in its "
          "middle give the depth, z = f dY / dy, with 1 sigma from |dz| = z^2 |dy| / (f dY). Depth "
          "is "
          "along the camera's axis, range along the segment's direction.",
      .examples = {"facula simulate data/scenes/wall_ahead.toml --rig data/rigs/two_line_air.toml "
                   "--conditions data/conditions/two_lines.toml --out wall",
                   "facula measure two-line wall/frames/0000.png --rig "
                   "data/rigs/two_line_air.toml --spacing-mm 100",
                   "facula measure two-line wall/frames/0000.png --rig "
                   "data/rigs/two_line_air.toml --spacing-mm 100 --method hough"},
      .declare = [a](Arguments& arguments) { declare(arguments, *a); },
      .run = [a](Session& session) { run(*a, session); }};
}

}  // namespace facula
