// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/cli/number_text.hpp>
#include <facula/apps/commands/flatness_figures.hpp>

#include <algorithm>
#include <limits>

namespace facula {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

std::vector<FigureValue> row_of(std::size_t number, const MeasuredFlatness& surface) {
  const Flatness& f = surface.flatness;
  const FlatnessUncertainty none{kUnknown, kUnknown, kUnknown, kUnknown, kUnknown};
  const FlatnessUncertainty u = surface.uncertainty.value_or(none);
  return {static_cast<long long>(number),
          static_cast<long long>(f.points),
          1000 * f.total,
          1000 * u.total_sigma,
          1000 * f.peak,
          1000 * f.valley,
          1000 * f.root_mean_square,
          f.minimum_zone ? 1000 * f.minimum_zone->total : kUnknown,
          1000 * u.sigma_points,
          1000 * u.floor_mean,
          1000 * u.floor_p95};
}

}  // namespace

FigureTable flatness_table(const std::vector<MeasuredFlatness>& surfaces) {
  FigureTable table{"flatness",
                    "Flatness (ISO 12781-1):",
                    {{"plane", "plane", 0},
                     {"points", "points", 0},
                     {"flt_t_mm", "FLTt", 4},
                     {"flt_t_sigma_mm", "sigma of FLTt", 4},
                     {"flt_p_mm", "FLTp", 4},
                     {"flt_v_mm", "FLTv", 4},
                     {"flt_q_mm", "FLTq", 4},
                     {"minimum_zone_mm", "minimum zone", 4},
                     {"noise_mm", "noise", 4},
                     {"noise_flt_t_mm", "FLTt of noise alone", 4},
                     {"noise_flt_t_p95_mm", "95 of 100 below", 4}},
                    {}};
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    table.rows.push_back(row_of(i + 1, surfaces[i]));
  }
  return table;
}

std::string flatness_verdict(const MeasuredFlatness& surface) {
  if (!surface.uncertainty) {
    return "The noise of the points is not known, so FLTt is that of surface and noise together.";
  }
  const FlatnessUncertainty& u = *surface.uncertainty;
  const std::string floor = fixed_text(1000 * u.floor_p95, 3) + " mm";
  if (surface.flatness.total <= u.floor_p95) {
    return "A perfectly flat surface would show up to " + floor +
           " by noise alone, so no deviation from flat is proven.";
  }
  return "Noise alone would show up to " + floor + "; what is above it is the surface's.";
}

bool is_cut(const MeasuredFlatness& surface, const SearchBand& band) {
  // Noise alone has a root mean square of a quarter of the band, which is 4 sigma; points that fill
  // it evenly, 0.58 of it.
  const bool by_noise = band.widened && surface.uncertainty;
  const double reach = std::max(band.reach, by_noise ? 4 * surface.uncertainty->sigma_points : 0.0);
  return surface.flatness.total > 1.6 * reach && surface.flatness.root_mean_square > 0.29 * reach;
}

}  // namespace facula
