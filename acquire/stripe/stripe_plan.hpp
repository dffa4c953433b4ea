// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/stripe/fir_shape.hpp>
#include <facula/acquire/stripe/line_search.hpp>
#include <facula/acquire/stripe/stripe_detector.hpp>

#include <array>
#include <cstdint>
#include <cstring>
#include <span>

namespace facula {

/// Rows measured at once: whole vectors of 16-bit lanes, one lane a row, whatever their width.
constexpr int kBatchRows = 32;
/// Columns of a row that fit about one peak. [px]
constexpr int kMostWindow = 56;
constexpr double kMostSigma = 4;

/// Rows that lie in memory as bytes or as 16-bit numbers: columns [begin, end) of each.
template <typename Value>
struct RowPart {
  const Value* values = nullptr;  ///< values[c - begin]
  int begin = 0;                  ///< [px]
  int end = 0;                    ///< [px]
};

/// A kernel laid over a window of pixels, two neighbours in one 32-bit number.
struct PairWeights {
  int first = 0;  ///< pairs [first, last) that count
  int last = 0;
  std::array<std::int32_t, kMostWindow / 2> pairs{};

  /// `weights` begin at pixel `from` of the window.
  void lay(std::span<const std::int16_t> weights, int from) {
    std::array<std::int16_t, kMostWindow> all{};
    std::copy(weights.begin(), weights.end(), all.begin() + from);
    std::memcpy(pairs.data(), all.data(), sizeof(pairs));
    first = from / 2;
    last = (from + static_cast<int>(weights.size()) + 1) / 2;
  }
};

/// What the vector code needs to know, worked out once per frame.
struct StripePlan {
  LineSearch search;
  FirShape shape;
  int settle_reach = 0;   ///< of the window a row is settled in, to both sides [px]
  int settle_eights = 0;  ///< groups of 8 px in it
  int fine_reach = 0;     ///< the same where it is measured [px]
  int fine_eights = 0;
  std::array<PairWeights, 5> slope;  ///< about columns -2..2 off the peak
  PairWeights smooth;
  PairWeights curvature;
  PairWeights beside;
  PairWeights under;  ///< 1 where the profile is held up

  explicit StripePlan(double sigma) : search(line_search(sigma)), shape(fir_shape(sigma)) {
    settle_reach = search.reach + search.box;
    settle_eights = (2 * settle_reach + 8) / 8;
    fine_reach = shape.reach();
    fine_eights = (2 * fine_reach + 8) / 8;
    const auto& kernels = shape.kernels;
    for (int i = 0; i < 5; ++i) {
      slope[static_cast<std::size_t>(i)].lay(kernels.slope.weights,
                                             fine_reach + i - 2 - kernels.slope.radius());
    }
    smooth.lay(kernels.smooth.weights, fine_reach - kernels.smooth.radius());
    curvature.lay(kernels.curvature.weights, fine_reach - kernels.curvature.radius());
    std::vector<std::int16_t> ones(static_cast<std::size_t>(2 * shape.misfit_reach + 1), 1);
    under.lay(ones, fine_reach - shape.misfit_reach);
    ones.assign(static_cast<std::size_t>(2 * shape.background_to + 1), 0);
    const int gap = shape.background_to - shape.background_from + 1;
    std::fill_n(ones.begin(), gap, std::int16_t{1});
    std::fill_n(ones.rbegin(), gap, std::int16_t{1});
    beside.lay(ones, fine_reach - shape.background_to);
  }
};

/// The plan for a width [px]; each thread keeps the last one, since frames follow one another.
inline const StripePlan& plan_for(double sigma) {
  thread_local StripePlan plan(sigma);
  thread_local double planned = sigma;
  if (planned != sigma) {
    plan = StripePlan(sigma);
    planned = sigma;
  }
  return plan;
}

}  // namespace facula
