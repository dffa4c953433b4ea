// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/capture/stripe_settings.hpp>
#include <facula/acquire/core/error.hpp>

#include <cmath>
#include <locale>
#include <sstream>

namespace facula {
namespace {

ImageRegion read_region(TomlTable& table) {
  if (!table.has("region_px")) return {};
  const std::string where = table.where("region_px");
  const std::vector<double> r = table.numbers("region_px");
  require(r.size() == 4, where, ": expected [x, y, width, height]");
  return {whole_pixels(r[0], where),
          whole_pixels(r[1], where),
          whole_pixels(r[2], where),
          whole_pixels(r[3], where)};
}

}  // namespace

int whole_pixels(double value, const std::string& where) {
  require(value == std::round(value) && std::abs(value) <= 100000,
          where,
          ": expected whole pixels, got ",
          value);
  return static_cast<int>(value);
}

StripeOptions read_stripe_options(TomlTable table, StripeDirection direction) {
  StripeOptions options;
  if (const auto name = table.text_if("detector")) options.detector = detector_from_name(*name);
  if (const auto name = table.text_if("channel")) options.channel = channel_from_name(*name);
  options.direction = direction;
  options.sigma = table.number_if("sigma_px").value_or(options.sigma);
  options.min_snr = table.number_if("min_snr").value_or(options.min_snr);
  options.min_amplitude = table.number_if("min_amplitude").value_or(options.min_amplitude);
  options.max_width_ratio = table.number_if("max_width_ratio").value_or(options.max_width_ratio);
  options.min_run = table.integer_if("min_run").value_or(options.min_run);
  options.median_rows = table.integer_if("median_rows").value_or(options.median_rows);
  options.max_candidates = table.integer_if("max_candidates").value_or(options.max_candidates);
  if (const auto name = table.text_if("hue")) options.hue = hue_from_name(*name);
  options.min_hue_share = table.number_if("min_hue_share").value_or(options.min_hue_share);
  options.region = read_region(table);
  table.finish();
  options.check();
  return options;
}

void write_stripe_options(std::ostream& stream, const StripeOptions& options) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out.precision(17);
  const ImageRegion& region = options.region;
  out << "[stripe]\ndetector = \"" << to_string(options.detector) << "\"\nchannel = \""
      << to_string(options.channel) << "\"\nsigma_px = " << options.sigma
      << "\nmin_snr = " << options.min_snr << "\nmin_amplitude = " << options.min_amplitude
      << "\nmax_width_ratio = " << options.max_width_ratio << "\nmin_run = " << options.min_run
      << "\nmedian_rows = " << options.median_rows
      << "\nmax_candidates = " << options.max_candidates << "\nhue = \"" << to_string(options.hue)
      << "\"\nmin_hue_share = " << options.min_hue_share << "\nregion_px = [" << region.x << ", "
      << region.y << ", " << region.width << ", " << region.height << "]\n";
  stream << out.str();
}

}  // namespace facula
