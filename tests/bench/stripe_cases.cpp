// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/tests/bench/stripe_cases.hpp>

#include <array>
#include <cmath>

namespace facula {
namespace {

constexpr int kRows = 1000;  // of one image
constexpr int kCols = 200;
constexpr double kLean = 0.0137;  // px per row: every place within a pixel comes up

std::string number(double value) {
  std::string text = std::to_string(value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

LineImage line_of(double sigma, double amplitude, double noise) {
  LineImage line;
  line.rows = kRows;
  line.cols = kCols;
  line.sigma = sigma;
  line.amplitude = amplitude;
  line.noise = noise;
  line.position = [](int r) { return 0.5 * kCols + kLean * (r - 0.5 * kRows); };
  return line;
}

std::string label(const LineImage& line) {
  std::string text = "s";
  text += number(line.sigma);
  text += " A";
  text += number(line.amplitude);
  text += " n";
  text += number(line.noise);
  return text;
}

void add(const std::string& what, const LineImage& line, std::vector<PrecisionCase>& cases) {
  cases.push_back({label(line) + ", " + what, "special", line, {}, 0});
}

constexpr double kTurn = 40;  // px after which a leaning line turns back
constexpr int kClear = 10;    // rows on both sides of a turn that do not count

int rows_to_turn(double lean) {
  return static_cast<int>(std::lround(kTurn / lean));
}

/// A line that leans by `lean` px per row and turns back every 40 px.
LineImage leaning(LineImage line, double lean) {
  const int turn = rows_to_turn(lean);
  line.position = [lean, turn](int r) {
    const int at = r % (2 * turn);
    return 0.5 * kCols - 0.5 * kTurn + kLean * 0.1 * (r - 0.5 * kRows) +
           lean * (at < turn ? at : 2 * turn - at);
  };
  return line;
}

constexpr int kStepEvery = 40;  // rows
constexpr int kNear = 8;        // rows on both sides of a step

/// Steps of 12 px to and fro. `blur` is the standard deviation over which the optics spread each
/// end of the line along the stripe [rows]; the edge lies anywhere within a row.
LineImage stepping(LineImage line, double blur) {
  line.second_offset = 12;
  line.second_share = [blur](int r) {
    const int step = (r + kStepEvery / 2) / kStepEvery;  // nearest
    const double edge = step * kStepEvery - 0.5 + (blur > 0 ? std::sin(12.9898 * step) / 2 : 0);
    const double beyond =
        blur > 0 ? 0.5 * std::erfc((edge - r) / (blur * std::sqrt(2.0))) : (r > edge ? 1.0 : 0.0);
    return step % 2 == 1 ? beyond : 1 - beyond;
  };
  return line;
}

bool near_step(int r) {
  const int at = r % kStepEvery;
  return r >= kStepEvery / 2 && (at < kNear || at >= kStepEvery - kNear);
}

void add_step(const std::string& what, const LineImage& line, std::vector<PrecisionCase>& cases) {
  cases.push_back({label(line) + ", " + what, "special", line, near_step, 0});
}

}  // namespace

std::vector<PrecisionCase> precision_cases() {
  std::vector<PrecisionCase> cases;
  for (const double sigma : {1.0, 2.0, 4.0}) {
    for (const double amplitude : {40.0, 60.0, 100.0, 200.0, 800.0}) {
      for (const double noise : {1.0, 2.0, 4.0}) {
        const LineImage line = line_of(sigma, amplitude, noise);
        cases.push_back({label(line), "grid", line, {}, 0});
      }
    }
  }
  for (const double sigma : {0.7, 1.0, 1.4, 2.8, 4.0}) {
    add("2 px expected", line_of(sigma, 200, 2), cases);
    cases.back().expected = 2;
  }
  for (const double lean : {0.1, 0.5, 1.0}) {
    const int turn = rows_to_turn(lean);
    add("leaning " + number(lean) + " px/row", leaning(line_of(2, 200, 2), lean), cases);
    cases.back().counts = [turn](int r) { return r % turn >= kClear && r % turn < turn - kClear; };
  }
  for (const double slope : {0.2, 1.0}) {
    LineImage line = line_of(2, 200, 2);
    line.slope = slope;
    line.cols = 60;  // narrow, not to clip at the bright end
    line.position = [](int r) { return 30 + kLean * (r - 0.5 * kRows); };
    add("ramp of " + number(slope) + " DN/px", line, cases);
  }
  for (const double sigma : {1.0, 2.0, 4.0}) {
    LineImage line = line_of(sigma, 200, 1);
    line.photons = 0.1;
    add("photons 0.1 DN", line, cases);
  }
  add_step("step of 12 px", stepping(line_of(2, 200, 4), 0), cases);
  add_step("step of 12 px, edge spread over 0.5 rows", stepping(line_of(2, 200, 4), 0.5), cases);
  add_step("step of 12 px, edge spread over 2 rows", stepping(line_of(2, 200, 4), 2), cases);
  return cases;
}

PrecisionResult measure_case(const PrecisionCase& which, int trials) {
  const std::vector<std::string> names = detector_names();
  PrecisionResult result;
  result.bound = line_bound(which.line);
  result.errors.resize(names.size());
  LineImage line = which.line;
  for (int done = 0; done < trials; done += kRows) {
    line.seed = 1 + static_cast<std::uint64_t>(done / kRows);
    const Image8 image = draw(line);
    for (std::size_t d = 0; d < names.size(); ++d) {
      StripeOptions options;
      options.detector = detector_from_name(names[d]);
      options.sigma = which.expected > 0 ? which.expected : line.sigma;
      add_errors(line, detect_stripe(image.view(), {}, options), which.counts, result.errors[d]);
    }
  }
  return result;
}

}  // namespace facula
