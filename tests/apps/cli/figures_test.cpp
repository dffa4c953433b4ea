// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/cli/figures.hpp>
#include <facula/apps/cli/number_text.hpp>
#include <facula/apps/cli/progress_bar.hpp>

#include <limits>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace facula {
namespace {

TEST(Figures, StandInTextAndJsonAlike) {
  Figures figures;
  figures.number("rms_mm", "rms", 1.23456, 2);
  figures.count("points", "points", 42);
  figures.part("map", "Map:").flag("closed", "closed", true);
  figures.table({"rows", "Rows:", {{"name", "name", 0}, {"angle_deg", "angle", 1}}, {{"a", 0.25}}});
  EXPECT_EQ(figures.text(),
            "  rms     1.23 mm\n"
            "  points    42\n"
            "Rows:\n"
            "  name  angle [deg]\n"
            "  a             0.2\n"
            "Map:\n"
            "  closed  yes\n");
  const auto json = nlohmann::json::parse(figures.json());
  EXPECT_EQ(json["rms_mm"], 1.23456);
  EXPECT_EQ(json["points"], 42);
  EXPECT_EQ(json["map"]["closed"], true);
  EXPECT_EQ(json["rows"][0]["angle_deg"], 0.25);
}

TEST(Figures, HugeNumbersStayShort) {
  EXPECT_EQ(fixed_text(-1e308, 4), "-1.000e+308");
  EXPECT_EQ(fixed_text(1234567.8912, 2), "1234567.89");
}

TEST(Figures, UnknownNumbersAreNull) {
  Figures figures;
  figures.number("rms_mm", "rms", std::numeric_limits<double>::quiet_NaN(), 2);
  EXPECT_TRUE(nlohmann::json::parse(figures.json())["rms_mm"].is_null());
}

TEST(Figures, TakeNamesThatAreNotUtf8) {
  Figures figures;
  figures.text("file", "file", "scan\xff.pcd");
  EXPECT_TRUE(nlohmann::json::accept(figures.json()));
}

TEST(FixedText, NeverShowsMinusZero) {
  EXPECT_EQ(fixed_text(-0.0004, 3), "0.000");
  EXPECT_EQ(fixed_text(-0.0006, 3), "-0.001");
}

TEST(ProgressBar, LineShowsShareAndTimeLeft) {
  EXPECT_EQ(ProgressBar::line("meshing", 1, 4, 10),
            "meshing [######..................] 25 %  ETA 30 s");
  EXPECT_EQ(ProgressBar::line("meshing", 1, 16, 10).substr(34), " 6 %  ETA 2 min 30 s");
  EXPECT_EQ(ProgressBar::line("meshing", 0, 0, 3), "meshing  3 s");
}

}  // namespace
}  // namespace facula
