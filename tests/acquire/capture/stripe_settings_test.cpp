// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/capture/stripe_settings.hpp>
#include <facula/acquire/rig/toml_table.hpp>

#include <sstream>
#include <string>

#include <gtest/gtest.h>

namespace facula {
namespace {

/// Every option away from its default: one that is not written comes back as the default.
StripeOptions all_changed() {
  StripeOptions o;
  o.detector = DetectorKind::kSteger;
  o.channel = Channel::kBlueExcess;
  o.direction = StripeDirection::kPerColumn;
  o.sigma = 1.0 / 3;
  o.sigma += 1;
  o.min_snr = 7.1;
  o.min_amplitude = 9.3;
  o.max_width_ratio = 3.7;
  o.min_run = 6;
  o.median_rows = 3;
  o.region = {1, 2, 30, 40};
  o.max_candidates = 5;
  o.hue = LaserHue::kGreen;
  o.min_hue_share = 0.1;
  return o;
}

std::string written(const StripeOptions& options) {
  std::ostringstream text;
  write_stripe_options(text, options);
  return text.str();
}

StripeOptions read(const std::string& text, StripeDirection direction) {
  return read_stripe_options(TomlTable::from_text(text, "test").table("stripe"), direction);
}

TEST(StripeSettings, EveryOptionComesBackAsWritten) {
  const StripeOptions options = all_changed();
  // If this does not compile, an option was added: change it in all_changed() and compare it below.
  const auto& [detector,
               channel,
               direction,
               sigma,
               min_snr,
               min_amplitude,
               max_width_ratio,
               min_run,
               median_rows,
               region,
               max_candidates,
               hue,
               min_hue_share] = read(written(options), options.direction);
  EXPECT_EQ(detector, options.detector);
  EXPECT_EQ(channel, options.channel);
  EXPECT_EQ(direction, options.direction);
  EXPECT_EQ(sigma, options.sigma);
  EXPECT_EQ(min_snr, options.min_snr);
  EXPECT_EQ(min_amplitude, options.min_amplitude);
  EXPECT_EQ(max_width_ratio, options.max_width_ratio);
  EXPECT_EQ(min_run, options.min_run);
  EXPECT_EQ(median_rows, options.median_rows);
  EXPECT_EQ(region.x, options.region.x);
  EXPECT_EQ(region.y, options.region.y);
  EXPECT_EQ(region.width, options.region.width);
  EXPECT_EQ(region.height, options.region.height);
  EXPECT_EQ(max_candidates, options.max_candidates);
  EXPECT_EQ(hue, options.hue);
  EXPECT_EQ(min_hue_share, options.min_hue_share);
}

TEST(StripeSettings, EveryKeyThatIsReadIsWritten) {
  // Each option above differs from its default in the text, too: as many lines differ as there are.
  std::istringstream changed(written(all_changed()));
  std::istringstream plain(written({}));
  int lines = 0;
  for (std::string a, b; std::getline(changed, a) && std::getline(plain, b);) {
    if (a == "[stripe]") continue;
    ++lines;
    EXPECT_NE(a, b);
  }
  EXPECT_EQ(lines, 12);  // all fields but the direction, which the rig says
}

}  // namespace
}  // namespace facula
