// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/median.hpp>
#include <facula/acquire/stripe/candidate_judgement.hpp>
#include <facula/acquire/stripe/detector_table.hpp>
#include <facula/acquire/stripe/line_kernels.hpp>
#include <facula/acquire/stripe/locate.hpp>
#include <facula/acquire/stripe/row_noise.hpp>
#include <facula/acquire/stripe/search_area.hpp>
#include <facula/acquire/stripe/stripe_choice.hpp>
#include <facula/acquire/stripe/stripe_path.hpp>

#include <algorithm>
#include <cmath>
#include <memory>

namespace facula {
namespace {

/// A peak that passed every test of its own row.
struct Choice {
  RowPeak peak;
  StripeCandidate candidate;
};

struct RowChoices {
  std::vector<Choice> choices;  ///< strongest first
  float row_noise = 0;          ///< [DN]
};

struct Span {
  int begin = 0;
  int end = 0;
};

bool has_gate(const StripeView& view) {
  return view.gate != nullptr && !view.gate->empty();
}

/// Looks at single rows of one frame.
class RowChooser {
 public:
  RowChooser(const StripeSignal& signal, const StripeView& view, const StripeOptions& options)
      : signal_(signal),
        view_(view),
        options_(options),
        kernels_(line_kernels(options.sigma)),
        detector_(make_detector(options)),
        area_(search_area(signal.rows(), signal.cols(), options)),
        noise_(estimate_noise(signal)) {}

  float noise() const { return noise_; }

  RowChoices choices_of_row(int r) const {
    RowChoices row;
    const Span columns = columns_of(r);
    const LocatedRow located = locate_in_row(
        signal_.row(r), kernels_, columns.begin, columns.end, options_.max_candidates);
    row.row_noise = located.row_noise;
    for (const RowPeak& peak : located.peaks) {
      auto found = detector_->measure(signal_, r, peak.column);
      if (!found) continue;
      found->row_noise = located.row_noise;
      const bool kept = stands_out(*found, noise_, options_) && is_inside(*found, columns) &&
                        !is_known(*found, row) && has_hue(*found, r) &&
                        !touches_movement(*found, r);
      if (kept) row.choices.push_back({peak, *found});
    }
    return row;
  }

 private:
  /// The columns of a row that the region and the gate leave.
  Span columns_of(int r) const {
    if (r < area_.first || r >= area_.last) return {};
    if (!has_gate(view_)) return {area_.begin, area_.end};
    const auto i = static_cast<std::size_t>(r);
    return {std::max(area_.begin, static_cast<int>(view_.gate->first[i])),
            std::min(area_.end, static_cast<int>(view_.gate->end[i]))};
  }

  static bool is_inside(const StripeCandidate& found, const Span& columns) {
    return found.position >= static_cast<float>(columns.begin) - 0.5F &&
           found.position <= static_cast<float>(columns.end) - 0.5F;
  }

  /// The flank of a strong line may be a peak of its own that leads to the same place.
  bool is_known(const StripeCandidate& found, const RowChoices& row) const {
    return std::any_of(row.choices.begin(), row.choices.end(), [&](const Choice& other) {
      return std::abs(static_cast<double>(other.candidate.position - found.position)) <
             options_.sigma;
    });
  }

  bool has_hue(const StripeCandidate& found, int r) const {
    const bool transposed = options_.direction == StripeDirection::kPerColumn;
    const StripePlace place = {r, found.position, found.width, transposed};
    return hue_share(view_.frame, view_.background, place, options_.hue) >= options_.min_hue_share;
  }

  /// Whether something moved in the pixels that the position is taken from.
  bool touches_movement(const StripeCandidate& found, int r) const {
    if (view_.moving.empty()) return false;
    const int reach = static_cast<int>(std::ceil(3 * options_.sigma)) + 1;
    const int middle = static_cast<int>(std::lround(found.position));
    const bool transposed = options_.direction == StripeDirection::kPerColumn;
    const int last = std::min(signal_.cols() - 1, middle + reach);
    for (int c = std::max(0, middle - reach); c <= last; ++c) {
      if ((transposed ? view_.moving.row(c)[r] : view_.moving.row(r)[c]) != 0) return true;
    }
    return false;
  }

  const StripeSignal& signal_;
  const StripeView& view_;
  const StripeOptions& options_;
  LineKernels kernels_;
  std::unique_ptr<RowDetector> detector_;
  SearchArea area_;
  float noise_;
};

/// The usual width of the strongest candidates [px]; the expected one where there are too few.
double usual_width(const std::vector<RowChoices>& rows, const StripeOptions& options) {
  std::vector<float> widths;
  for (const RowChoices& row : rows) {
    if (!row.choices.empty()) widths.push_back(row.choices.front().candidate.width);
  }
  if (widths.size() < 16) return options.sigma;
  return std::max(0.5, static_cast<double>(median(widths)));
}

/// What a candidate is worth to a path: 0.5 for one that just stands out, up to 2 for one 8 times
/// as strong, less where its width is not the usual one (a factor of 2 costs 0.5).
double gain_of(const StripeCandidate& found,
               double frame_noise,
               double width,
               const StripeOptions& options) {
  const double noise = static_cast<double>(noise_about(found, static_cast<float>(frame_noise)));
  const double strength =
      std::log2(static_cast<double>(found.snr_per_noise) / (noise * options.min_snr));
  const double misfit = std::log2(std::max(0.5, static_cast<double>(found.width)) / width);
  return 0.5 + 0.5 * std::clamp(strength, 0.0, 3.0) - 0.5 * std::min(1.0, misfit * misfit);
}

std::vector<int> path_through(const std::vector<RowChoices>& rows,
                              double noise,
                              const StripeOptions& options) {
  const double width = usual_width(rows, options);
  std::vector<std::vector<PathPlace>> places(rows.size());
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (const Choice& choice : rows[r].choices) {
      places[r].push_back({static_cast<double>(choice.candidate.position),
                           gain_of(choice.candidate, noise, width, options)});
    }
  }
  return best_path(places, {.step = options.sigma + 1});
}

void check_view(const StripeView& view, std::size_t rows) {
  require(!has_gate(view) || (view.gate->first.size() == rows && view.gate->end.size() == rows),
          "expected a gate with one span for each of ",
          rows,
          " rows");
  require(view.moving.empty() || (view.moving.rows == view.frame.rows &&
                                  view.moving.cols == view.frame.cols && view.moving.channels == 1),
          "expected moving pixels of the frame's size");
}

constexpr int kPeaksAtGate = 3;  // two may be flanks of lines beyond its ends

/// Where only a gate asks: the strongest peak of every row, in rows where that lies outside of the
/// gate the strongest inside.
StripeLocation locate_within(const ColumnGate& gate,
                             const StripeSignal& signal,
                             const StripeOptions& options) {
  StripeLocation location = locate_stripe(signal, options);
  const LineKernels kernels = line_kernels(options.sigma);
  const SearchArea area = search_area(signal.rows(), signal.cols(), options);
  for (std::size_t r = 0; r < location.size(); ++r) {
    const int peak = location.peak[r];
    if (peak < 0 || (peak >= gate.first[r] && peak < gate.end[r])) continue;
    const LocatedRow located = locate_in_row(signal.row(static_cast<int>(r)),
                                             kernels,
                                             std::max(area.begin, static_cast<int>(gate.first[r])),
                                             std::min(area.end, static_cast<int>(gate.end[r])),
                                             kPeaksAtGate);
    // The flank of a line outside of the gate leads out of it.
    const auto inside =
        std::find_if(located.peaks.begin(), located.peaks.end(), [&](const RowPeak& p) {
          return p.column >= gate.first[r] && p.column < gate.end[r];
        });
    location.peak[r] = inside == located.peaks.end() ? -1 : inside->column;
    if (inside == located.peaks.end()) continue;
    location.peak_per_noise[r] = inside->response;
    location.row_noise[r] = std::max(location.row_noise[r], located.row_noise);
  }
  return location;
}

}  // namespace

StripeLocation choose_stripe(const StripeSignal& signal,
                             const StripeView& view,
                             const StripeOptions& options) {
  const auto count = static_cast<std::size_t>(signal.rows());
  check_view(view, count);
  if (!asks_for_choice(options) && view.moving.empty() && has_gate(view)) {
    return locate_within(*view.gate, signal, options);
  }
  const RowChooser chooser(signal, view, options);
  std::vector<RowChoices> rows(count);
  for (std::size_t r = 0; r < count; ++r) rows[r] = chooser.choices_of_row(static_cast<int>(r));
  const std::vector<int> path = path_through(rows, static_cast<double>(chooser.noise()), options);

  StripeLocation location = StripeLocation::none(count);
  location.noise = chooser.noise();
  for (std::size_t r = 0; r < count; ++r) {
    location.row_noise[r] = rows[r].row_noise;
    if (path[r] < 0) continue;
    const RowPeak& peak = rows[r].choices[static_cast<std::size_t>(path[r])].peak;
    location.peak[r] = peak.column;
    location.peak_per_noise[r] = peak.response;
  }
  return location;
}

bool asks_for_choice(const StripeOptions& options) {
  return options.max_candidates > 1 || options.hue != LaserHue::kAny;
}

bool needs_choice(const StripeView& view, const StripeOptions& options) {
  return asks_for_choice(options) || has_gate(view) || !view.moving.empty();
}

StripeProfile detect_stripe(const StripeView& view, const StripeOptions& options) {
  options.check();
  require(!view.frame.empty(), "expected a frame with pixels, got an empty one");
  if (!needs_choice(view, options)) return detect_stripe(view.frame, view.background, options);
  const bool transposed = options.direction == StripeDirection::kPerColumn;
  const StripeSignal signal(view.frame, view.background, options.channel, transposed);
  return measure_stripe(signal, choose_stripe(signal, view, options), options);
}

StripeProfile detect_stripe(ImageView8 frame,
                            ImageView8 background,
                            const StripeOptions& options,
                            const ColumnGate& gate) {
  return detect_stripe(StripeView{frame, background, &gate}, options);
}

}  // namespace facula
