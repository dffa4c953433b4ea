// SPDX-License-Identifier: GPL-3.0-or-later
// A frame in batches of rows: located, settled, measured. Included once per instruction set; see
// stripe_simd.cpp.
#if defined(FACULA_FRAME_SIMD) == defined(HWY_TARGET_TOGGLE)
#ifdef FACULA_FRAME_SIMD
#undef FACULA_FRAME_SIMD
#else
#define FACULA_FRAME_SIMD
#endif

#include <cmath>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace facula {
namespace HWY_NAMESPACE {

/// Grey pixels as they are.
struct GreyRows {
  using Value = std::uint8_t;
  ImageView8 frame;

  RowPart<Value> row(int r) const { return {frame.row(r), 0, frame.cols}; }
  int rows() const { return frame.rows; }
  int cols() const { return frame.cols; }
  void make(int, int) const {}
  const Value* make_one(int r) const { return frame.row(r); }
  bool has_flags() const { return false; }
  bool is_clipped(int r, int c) const {
    return frame.row(r)[std::clamp(c, 0, frame.cols - 1)] == 255;
  }
};

/// Rows that are made batch by batch: a channel, the background taken off.
class MadeRows {
 public:
  using Value = std::int16_t;

  MadeRows(const StripeView& view, Channel channel)
      : view_(view), channel_(channel), values_(kBatchRows * width()) {}

  void make(int first, int count) {
    first_ = first;
    for (int q = 0; q < count; ++q) make_row(first + q, q);
  }
  /// One row alone, in place of what was made before.
  const Value* make_one(int r) {
    make_row(r, 0);
    return values_.data();
  }
  RowPart<Value> row(int r) const {
    return {values_.data() + static_cast<std::size_t>(r - first_) * width(), 0, cols()};
  }
  int rows() const { return view_.frame.rows; }
  int cols() const { return view_.frame.cols; }
  bool has_flags() const { return true; }
  bool is_clipped(int r, int c) const {
    const int step = view_.frame.channels;
    const std::uint8_t* p = view_.frame.row(r) + std::clamp(c, 0, cols() - 1) * step;
    return std::find(p, p + step, std::uint8_t{255}) != p + step;
  }

 private:
  std::size_t width() const { return static_cast<std::size_t>(cols()); }
  void make_row(int r, int q) {
    Value* to = values_.data() + static_cast<std::size_t>(q) * width();
    read_signal_row_of(view_.frame, view_.background, r, channel_, to);
  }

  StripeView view_;
  Channel channel_;
  std::vector<Value> values_;
  int first_ = 0;
};

struct SignalRows {
  using Value = std::int16_t;
  const StripeSignal& signal;

  RowPart<Value> row(int r) const {
    const SignalRow row = signal.row(r);
    return {row.values, row.begin, row.end};
  }
  int rows() const { return signal.rows(); }
  int cols() const { return signal.cols(); }
  void make(int, int) const {}
  const Value* make_one(int r) const { return signal.row(r).values; }
  bool has_flags() const { return true; }
  bool is_clipped(int r, int c) const { return signal.row(r).is_clipped(c); }
};

/// locate_stripe() batch by batch.
template <typename Rows>
class Locator {
 public:
  using Value = typename Rows::Value;

  Locator(const Rows& rows, const StripePlan& plan, const SearchArea& area, float noise)
      : rows_(rows),
        plan_(plan),
        last_(area.last),
        cols_(rows.cols()),
        range_(boxes_between({area.begin, area.end}, plan.search)),
        averaged_(plan.search, noise, true),
        single_(plan.search, noise, false),
        search_(plan.search, range_, rows.cols()) {}

  bool empty() const { return range_.first >= range_.last; }

  /// Rows [first, first + count), a whole number of groups but for the last.
  void locate(int first, int count, StripeLocation& location) {
    again_.clear();
    int groups = 0;
    for (int i = 0; i < count; i += kRowsAtOnce, ++groups) {
      for (int k = 0; k < kRowsAtOnce; ++k) {
        groups_[groups][static_cast<std::size_t>(k)] =
            rows_.row(std::min(first + i + k, last_ - 1)).values;
      }
    }
    search_.search(groups_, groups, averaged_, places_);
    batch_.count = 0;
    for (int i = 0; i < count; ++i) {
      const int g = i / kRowsAtOnce;
      if (places_[g].column < 0) {
        again_.push_back(first + i);
      } else {
        add(first + i, groups_[g][static_cast<std::size_t>(i % kRowsAtOnce)], g);
      }
    }
    settle(true, location);
    if (!again_.empty()) locate_alone(location);
  }

 private:
  /// Row r is to be settled where places_[place] says.
  HWY_INLINE void add(int r, const Value* values, int place) {
    const int q = batch_.count++;
    batch_.rows[q] = {values, 0, cols_};
    batch_.column[q] = static_cast<std::int16_t>(places_[place].column);
    row_[q] = r;
    place_[q] = place;
  }

  /// Rows that do not show the line of their group are looked at again where `may_repeat`.
  void settle(bool may_repeat, StripeLocation& location) {
    settle_rows(plan_, batch_);
    for (int q = 0; q < batch_.count; ++q) {
      const SettledLine line = {batch_.column[q] + batch_.shift[q], batch_.drop[q]};
      const bool settled =
          line.drop > 0 && static_cast<unsigned>(line.column) < static_cast<unsigned>(cols_);
      if (may_repeat && !(settled && shows(line, places_[place_[q]].height))) {
        again_.push_back(row_[q]);
      } else if (settled) {
        const auto r = static_cast<std::size_t>(row_[q]);
        location.peak[r] = line.column;
        location.peak_per_noise[r] = 0.5F * static_cast<float>(line.drop);
        location.row_noise[r] = places_[place_[q]].row_noise;
      }
    }
  }

  void locate_alone(StripeLocation& location) {
    const int count = static_cast<int>(again_.size());
    for (int i = 0; i < count; ++i) {
      groups_[i].fill(rows_.row(again_[static_cast<std::size_t>(i)]).values);
    }
    search_.search(groups_, count, single_, places_);
    batch_.count = 0;
    for (int i = 0; i < count; ++i) {
      if (places_[i].column >= 0) add(again_[static_cast<std::size_t>(i)], groups_[i][0], i);
    }
    settle(false, location);
  }

  const Rows& rows_;
  const StripePlan& plan_;
  int last_;
  int cols_;
  BoxRange range_;
  RowNoiseScale averaged_;
  RowNoiseScale single_;
  RowSearch search_;
  FourRows<Value> groups_[kBatchRows];
  LinePlace places_[kBatchRows];
  SettleBatch<Value> batch_;
  int row_[kBatchRows];
  int place_[kBatchRows];
  std::vector<int> again_;
};

/// The default detector batch by batch.
template <typename Rows>
class Measurer {
 public:
  Measurer(const Rows& rows, const StripePlan& plan) : rows_(rows), plan_(plan) {}

  /// Rows [first, first + count) about their peaks.
  void measure(int first, int count, const StripeLocation& location, MeasuredRows& measured) {
    for (int q = 0; q < count; ++q) {
      const int peak = location.peak[static_cast<std::size_t>(first + q)];
      batch_.rows[q] = rows_.row(first + q);
      const bool held = peak >= batch_.rows[q].begin && peak < batch_.rows[q].end;
      batch_.column[q] = held ? peak : -1;
      if (!held) batch_.rows[q] = {kNothing, 0, kMostWindow};
    }
    batch_.count = count;
    measure_rows_of_batch(plan_, batch_);
    const auto r = static_cast<std::size_t>(first);
    const auto n = static_cast<std::size_t>(count);
    const auto copy = [&](const float* from, float* to) { std::copy_n(from, n, to + r); };
    StripeProfile& profile = measured.profile;
    copy(batch_.position, profile.position.data());
    copy(batch_.amplitude, profile.amplitude.data());
    copy(batch_.width, profile.width.data());
    copy(batch_.snr_per_noise, measured.snr_per_noise());
    copy(batch_.sigma_per_noise, measured.sigma_per_noise());
    copy(batch_.residual, measured.residual());
    copy(batch_.residual_share, measured.residual_share());
    copy(batch_.position_share, measured.position_share());
    copy(location.row_noise.data() + r, measured.row_noise());
    for (std::size_t q = 0; q < n; ++q) {
      profile.seen[r + q] = batch_.column[q] >= 0 && batch_.found[q] != 0 ? 1 : 0;
    }
    if (batch_.any_clipped || rows_.has_flags()) judge_clipped_rows(first, count, measured);
  }

 private:
  static constexpr typename Rows::Value kNothing[kMostWindow] = {};

  void judge_clipped_rows(int first, int count, MeasuredRows& measured) {
    for (int q = 0; q < count; ++q) {
      const auto r = static_cast<std::size_t>(first + q);
      const float position = batch_.position[q];
      if (measured.profile.seen[r] == 0) continue;
      if (!rows_.is_clipped(first + q, static_cast<int>(std::floor(position + 0.5F)))) continue;
      measured.profile.saturated[r] = 1;
      StripeCandidate found;
      found.position = position;
      found.background = batch_.background[q];
      found.sigma_per_noise = batch_.sigma_per_noise[q];
      judge_row(first + q, batch_.top_bend[q], found);
      measured.sigma_per_noise()[r] = found.sigma_per_noise;
      measured.set_sigma_step(r, found.sigma_step);
    }
  }

  void judge_row(int r, float bend, StripeCandidate& found) {
    const RowPart<typename Rows::Value> row = rows_.row(r);
    values_.assign(row.values, row.values + (row.end - row.begin));
    flags_.resize(values_.size());
    for (int c = row.begin; c < row.end; ++c) {
      flags_[static_cast<std::size_t>(c - row.begin)] = rows_.is_clipped(r, c) ? 1 : 0;
    }
    judge_clipped(
        {values_.data(), flags_.data(), row.begin, row.end}, plan_.shape.sigma, bend, found);
  }

  const Rows& rows_;
  const StripePlan& plan_;
  MeasureBatch<typename Rows::Value> batch_;
  std::vector<std::int16_t> values_;
  std::vector<std::uint8_t> flags_;
};

template <typename Rows>
void locate_and_measure(Rows rows,
                        const StripeOptions& options,
                        StripeLocation& location,
                        MeasuredRows* measured) {
  const StripePlan& plan = plan_for(options.sigma);
  const SearchArea area = search_area(rows.rows(), rows.cols(), options);
  location.noise =
      estimate_noise(rows.rows(), rows.cols(), [&](int r) { return rows.make_one(r); });
  Locator<Rows> locator(rows, plan, area, location.noise);
  Measurer<Rows> measurer(rows, plan);
  if (measured != nullptr && area.last - area.first < rows.rows()) measured->clear();
  for (int r = area.first; r < area.last && !locator.empty(); r += kBatchRows) {
    const int count = std::min(kBatchRows, area.last - r);
    rows.make(r, count);
    locator.locate(r, count, location);
    if (measured != nullptr) measurer.measure(r, count, location, *measured);
  }
}

bool measure_frame(const StripeView& view,
                   const StripeOptions& options,
                   StripeLocation& location,
                   MeasuredRows* measured) {
  if (view.frame.channels == 1 && view.background.empty()) {
    locate_and_measure(GreyRows{view.frame}, options, location, measured);
  } else {
    locate_and_measure(MadeRows(view, options.channel), options, location, measured);
  }
  measured->profile.noise = location.noise;
  measured->residual_freedom = plan_for(options.sigma).shape.misfit_freedom();
  return true;
}

bool locate_signal(const StripeSignal& signal,
                   const StripeOptions& options,
                   StripeLocation& location) {
  locate_and_measure(SignalRows{signal}, options, location, nullptr);
  return true;
}

bool measure_signal(const StripeSignal& signal,
                    const StripeLocation& location,
                    const StripeOptions& options,
                    MeasuredRows& measured) {
  const StripePlan& plan = plan_for(options.sigma);
  const SignalRows rows{signal};
  Measurer<SignalRows> measurer(rows, plan);
  const int all = static_cast<int>(location.size());
  for (int r = 0; r < all; r += kBatchRows) {
    measurer.measure(r, std::min(kBatchRows, all - r), location, measured);
  }
  measured.residual_freedom = plan.shape.misfit_freedom();
  return true;
}

}  // namespace HWY_NAMESPACE
}  // namespace facula
HWY_AFTER_NAMESPACE();

#endif  // FACULA_FRAME_SIMD
