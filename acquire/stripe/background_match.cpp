// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/median.hpp>
#include <facula/acquire/stripe/background_match.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace facula {
namespace {

constexpr std::array<std::pair<Flicker, const char*>, 3> kNames = {{
    {Flicker::kIgnore, "ignore"},
    {Flicker::kFrame, "frame"},
    {Flicker::kRows, "rows"},
}};

constexpr int kClipped = 250;            // compression leaves clipped pixels a few DN below 255
constexpr int kRounds = 8;               // of trimming; the fit then moves no more
constexpr std::size_t kSamples = 40000;  // pixels looked at: gain to 1e-4 of a usual picture

/// A pixel of the background and what the frame has over it [DN].
struct Sample {
  float dark = 0;
  float over = 0;
};

/// over = slope * dark + offset.
struct Line {
  double slope = 0;
  double offset = 0;

  double misfit(const Sample& s) const {
    return static_cast<double>(s.over) - slope * static_cast<double>(s.dark) - offset;
  }
};

/// 3 standard deviations of most misfits, but not less than rounding makes.
double trim_at(const std::vector<Sample>& samples, const Line& line) {
  std::vector<float> sizes;
  sizes.reserve(samples.size());
  for (const Sample& s : samples) sizes.push_back(static_cast<float>(std::abs(line.misfit(s))));
  return std::max(1.5, 3 * 1.4826 * static_cast<double>(median(sizes)));
}

/// Least squares through the samples that `line` explains. The slope is held towards 0 as if one
/// more share of the samples, spread by 1 DN, had said so.
Line fit_trimmed(const std::vector<Sample>& samples, const Line& line) {
  const double limit = trim_at(samples, line);
  double n = 0;
  double x = 0;
  double y = 0;
  double xx = 0;
  double xy = 0;
  for (const Sample& s : samples) {
    if (std::abs(line.misfit(s)) > limit) continue;
    const auto dark = static_cast<double>(s.dark);
    const auto over = static_cast<double>(s.over);
    n += 1;
    x += dark;
    y += over;
    xx += dark * dark;
    xy += dark * over;
  }
  if (n < 2) return line;
  const double slope = (xy - x * y / n) / (xx - x * x / n + n);
  return {slope, (y - slope * x) / n};
}

Line fit_frame(const std::vector<Sample>& samples) {
  if (samples.size() < 100) return {};
  std::vector<float> over;
  over.reserve(samples.size());
  for (const Sample& s : samples) over.push_back(s.over);
  Line line = {0, static_cast<double>(median(over))};
  for (int round = 0; round < kRounds; ++round) line = fit_trimmed(samples, line);
  return line;
}

/// Pixels of one colour at an even spacing, clipped ones left out.
std::vector<Sample> samples_of(ImageView8 frame, ImageView8 background, int channel) {
  std::vector<Sample> samples;
  const auto pixels = static_cast<std::size_t>(frame.rows) * static_cast<std::size_t>(frame.cols);
  // An odd step does not keep to the same columns.
  const auto step = static_cast<int>(pixels / kSamples) | 1;
  int next = 0;
  for (int r = 0; r < frame.rows; ++r) {
    const std::uint8_t* lit = frame.row(r) + channel;
    const std::uint8_t* dark = background.row(r) + channel;
    for (; next < frame.cols; next += step) {
      const int l = lit[next * frame.channels];
      const int d = dark[next * frame.channels];
      if (l >= kClipped || d >= kClipped) continue;
      samples.push_back({static_cast<float>(d), static_cast<float>(l - d)});
    }
    next -= frame.cols;
  }
  return samples;
}

using Lines = std::vector<Line>;  // one per colour

double matched(const Line& line, int dark) {
  return dark + line.slope * dark + line.offset;
}

/// The share by which one row is brighter than the matched background.
double gain_of_row(ImageView8 frame, ImageView8 background, int r, const Lines& lines) {
  std::vector<Sample> samples;
  const std::uint8_t* lit = frame.row(r);
  const std::uint8_t* dark = background.row(r);
  for (int i = 0; i < frame.cols * frame.channels; ++i) {
    if (lit[i] >= kClipped || dark[i] >= kClipped) continue;
    const double expected = matched(lines[static_cast<std::size_t>(i % frame.channels)], dark[i]);
    samples.push_back({static_cast<float>(expected), static_cast<float>(lit[i] - expected)});
  }
  if (samples.size() < 32) return 0;
  Line gain;
  for (int round = 0; round < 3; ++round) {
    const double limit = trim_at(samples, gain);
    double xx = 0;
    double xy = 0;
    double yy = 0;
    double n = 0;
    for (const Sample& s : samples) {
      if (std::abs(gain.misfit(s)) > limit) continue;
      xx += static_cast<double>(s.dark * s.dark);
      xy += static_cast<double>(s.dark * s.over);
      yy += static_cast<double>(s.over * s.over);
      n += 1;
    }
    if (n < 16) return 0;
    // As if 5 % of flicker were usual: noise^2 / 0.05^2 beside the row's own weight.
    gain.slope = xy / (xx + yy / n * 400);
  }
  return gain.slope;
}

void check_pair(ImageView8 frame, ImageView8 background) {
  require(frame.rows == background.rows && frame.cols == background.cols &&
              frame.channels == background.channels,
          "expected a background of the frame's size and channels, ",
          frame.cols,
          " x ",
          frame.rows,
          " px with ",
          frame.channels,
          ", got ",
          background.cols,
          " x ",
          background.rows,
          " px with ",
          background.channels);
}

}  // namespace

Flicker flicker_from_name(const std::string& name) {
  for (const auto& [flicker, known] : kNames) {
    if (name == known) return flicker;
  }
  fail("expected what to do about flicker (ignore, frame, rows), got '", name, "'");
}

std::string to_string(Flicker flicker) {
  for (const auto& [known, name] : kNames) {
    if (known == flicker) return name;
  }
  return "ignore";
}

Image8 match_background(ImageView8 frame, ImageView8 background, Flicker flicker) {
  check_pair(frame, background);
  Lines lines(static_cast<std::size_t>(background.channels));
  for (std::size_t k = 0; flicker != Flicker::kIgnore && k < lines.size(); ++k) {
    lines[k] = fit_frame(samples_of(frame, background, static_cast<int>(k)));
  }
  Image8 result(background.rows, background.cols, background.channels);
  for (int r = 0; r < result.rows; ++r) {
    const double gain =
        flicker == Flicker::kRows ? 1 + gain_of_row(frame, background, r, lines) : 1.0;
    const std::uint8_t* dark = background.row(r);
    std::uint8_t* out = result.row(r);
    for (int i = 0; i < result.cols * result.channels; ++i) {
      const Line& line = lines[static_cast<std::size_t>(i % result.channels)];
      const double value = std::clamp(gain * matched(line, dark[i]), 0.0, 255.0);
      out[i] = static_cast<std::uint8_t>(std::lround(value));
    }
  }
  return result;
}

}  // namespace facula
