// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/simulate/conditions_file.hpp>
#include <facula/tests/acquire/simulate/small_head.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/real_data.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <fstream>
#include <numbers>

#include <gtest/gtest.h>

namespace facula {
namespace {

Rig turning_head() {
  Rig rig = small_head();
  rig.axis.kind = AxisKind::kPan;
  return rig;
}

class ConditionsFile : public testing::Test {
 protected:
  SimulateOptions read(const std::string& text, const Rig& rig) const {
    std::ofstream(folder_ / "conditions.toml") << text;
    return read_conditions(folder_ / "conditions.toml", rig, options_for(rig));
  }
  TemporaryFolder folder_;
};

TEST_F(ConditionsFile, ChangesWhatItNamesInItsUnits) {
  const SimulateOptions o = read(
      "[laser]\ncolour = \"green\"\nhalf_width_mm = 0.4\n[beam]\nwaist_um = 300\n"
      "[speckle]\nwavelength_nm = 532\npixel_um = 4\n[ambient]\nflicker_hz = 120\n"
      "[lens]\nblur_px = 0.7\n[timing]\nrow_us = 30\n"
      "[motion]\nbacklash_deg = 0.5\nspeed_deg_s = 9\nlatency_ms = 20\n",
      turning_head());
  EXPECT_EQ(o.laser_colour, LaserColour::kGreen);
  EXPECT_NEAR(o.line_half_width, 0.4e-3, 1e-15);
  EXPECT_NEAR(o.beam.value().waist, 300e-6, 1e-15);
  EXPECT_NEAR(o.speckle.value().wavelength, 532e-9, 1e-18);
  EXPECT_NEAR(o.speckle.value().pixel_pitch, 4e-6, 1e-15);
  EXPECT_EQ(o.flicker.frequency, 120);
  EXPECT_EQ(o.lens.blur, 0.7);
  EXPECT_NEAR(o.timing.row_time, 30e-6, 1e-15);
  EXPECT_NEAR(o.axis_errors.backlash, 0.5 * std::numbers::pi / 180, 1e-12);
  EXPECT_NEAR(o.axis_errors.speed, 9 * std::numbers::pi / 180, 1e-12);
  EXPECT_NEAR(o.axis_errors.latency, 0.02, 1e-12);
  const SimulateOptions untouched = options_for(turning_head());
  EXPECT_EQ(o.laser_peak, untouched.laser_peak);
  EXPECT_EQ(o.line_divergence, untouched.line_divergence);
}

TEST_F(ConditionsFile, SaysWhatIsWrong) {
  const auto error = [&](const std::string& text, const Rig& rig) {
    return error_of([&] { read(text, rig); });
  };
  EXPECT_NE(error("[lens]\nblurr_px = 1\n", small_head()).find("blur_px"), std::string::npos);
  EXPECT_NE(error("[lens]\nblur_px = -1\n", small_head()).find("lens.blur"), std::string::npos);
  EXPECT_NE(error("[laser]\ncolour = \"blue\"\n", small_head()).find("infrared"),
            std::string::npos);
  // A head that does not turn has no backlash in degrees.
  EXPECT_NE(error("[motion]\nbacklash_deg = 1\n", small_head()).find("backlash_mm"),
            std::string::npos);
  EXPECT_NE(error("[lenses]\n", small_head()).find("lens"), std::string::npos);
  EXPECT_NE(error("[speckle]\naverages = 0\n", small_head()).find("averages"), std::string::npos);
}

TEST_F(ConditionsFile, ShippedOnesAreRead) {
  for (const char* name : {"lit_room", "moving_head", "caltag_pot", "ciclop_bust"}) {
    const std::string path = std::string("conditions/") + name + ".toml";
    EXPECT_NO_THROW(read_conditions(shipped_data(path), turning_head(), options_for(small_head())))
        << name;
  }
}

}  // namespace
}  // namespace facula
