// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/stripe/bracket.hpp>

#include <cmath>
#include <cstddef>
#include <optional>

namespace facula {
namespace {

using Bracket = std::vector<ExposedProfile>;

void check(const Bracket& bracket, const BracketOptions& options) {
  require(!bracket.empty(), "expected a bracket of at least one exposure, got none");
  require(options.agreement > 0, "bracket agreement: expected above 0, got ", options.agreement);
  for (const ExposedProfile& exposed : bracket) {
    require(exposed.exposure > 0 && std::isfinite(exposed.exposure),
            "expected exposures above 0, got ",
            exposed.exposure);
    require(exposed.profile.size() == bracket.front().profile.size(),
            "expected exposures of one bracket with the same number of rows, got ",
            exposed.profile.size(),
            " and ",
            bracket.front().profile.size());
  }
}

/// Whether exposure a is better than b in row r: unclipped before clipped; of unclipped ones the
/// surer, of clipped ones the shorter.
bool is_better(const ExposedProfile& a, const ExposedProfile& b, std::size_t r) {
  const bool a_clipped = a.profile.saturated[r] != 0;
  const bool b_clipped = b.profile.saturated[r] != 0;
  if (a_clipped != b_clipped) return b_clipped;
  return a_clipped ? a.exposure < b.exposure : a.profile.sigma[r] < b.profile.sigma[r];
}

std::optional<std::size_t> best_of_row(const Bracket& bracket, std::size_t r) {
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < bracket.size(); ++i) {
    if (bracket[i].profile.seen[r] == 0) continue;
    if (!best || is_better(bracket[i], bracket[*best], r)) best = i;
  }
  return best;
}

void take(const ExposedProfile& from, double first_exposure, std::size_t r, StripeProfile& merged) {
  merged.seen[r] = 1;
  merged.position[r] = from.profile.position[r];
  merged.sigma[r] = from.profile.sigma[r];
  merged.amplitude[r] =
      from.profile.amplitude[r] * static_cast<float>(first_exposure / from.exposure);
  merged.width[r] = from.profile.width[r];
  merged.saturated[r] = from.profile.saturated[r];
}

/// Moves a row from its best exposure to the mean of those that agree with it.
void average(const Bracket& bracket,
             std::size_t best,
             std::size_t r,
             double agreement,
             StripeProfile& merged) {
  const StripeProfile& sure = bracket[best].profile;
  double weight = 0;
  double moment = 0;
  for (const ExposedProfile& exposed : bracket) {
    const StripeProfile& profile = exposed.profile;
    if (profile.seen[r] == 0 || profile.saturated[r] != 0 || !(profile.sigma[r] > 0)) continue;
    const auto off = static_cast<double>(profile.position[r] - sure.position[r]);
    const auto sigma = static_cast<double>(profile.sigma[r]);
    if (std::abs(off) > agreement * std::hypot(sigma, static_cast<double>(sure.sigma[r]))) return;
    weight += 1 / (sigma * sigma);
    moment += off / (sigma * sigma);
  }
  if (!(weight > 0)) return;
  merged.position[r] = sure.position[r] + static_cast<float>(moment / weight);
  merged.sigma[r] = static_cast<float>(1 / std::sqrt(weight));
}

}  // namespace

StripeProfile merge_bracket(const Bracket& bracket, const BracketOptions& options) {
  check(bracket, options);
  StripeProfile merged = StripeProfile::none(bracket.front().profile.size());
  merged.noise = bracket.front().profile.noise;
  for (std::size_t r = 0; r < merged.size(); ++r) {
    const auto best = best_of_row(bracket, r);
    if (!best) continue;
    take(bracket[*best], bracket.front().exposure, r, merged);
    if (options.combine && merged.saturated[r] == 0) {
      average(bracket, *best, r, options.agreement, merged);
    }
  }
  return merged;
}

}  // namespace facula
