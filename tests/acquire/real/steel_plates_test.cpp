// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/capture/frame_source.hpp>
#include <facula/acquire/stripe/stripe_detector.hpp>
#include <facula/tests/support/real_data.hpp>

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace facula {
namespace {

/// A row judged by eye; see data/labels/README.md.
struct Label {
  std::size_t row = 0;
  std::string seen;  ///< "yes", "faint" or "no"
  double position = 0;
  double mirror = -1;  ///< of the line's mirror image, -1 for none
};

std::map<std::string, std::vector<Label>> read_labels() {
  std::ifstream file(shipped_data("labels/ambient_steel_plates.csv"));
  std::map<std::string, std::vector<Label>> labels;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::istringstream cells(line);
    std::string picture;
    std::string row;
    std::string position;
    std::string uncertainty;
    std::string mirror;
    Label label;
    std::getline(cells, picture, ',');
    std::getline(cells, row, ',');
    std::getline(cells, label.seen, ',');
    std::getline(cells, position, ',');
    std::getline(cells, uncertainty, ',');
    std::getline(cells, mirror, ',');
    label.row = std::stoul(row);
    if (!position.empty()) label.position = std::stod(position);
    if (!mirror.empty()) label.mirror = std::stod(mirror);
    labels[picture].push_back(label);
  }
  return labels;
}

/// Rows counted against the labels. A find within 3 px is the line's: half of what the labeller
/// took for the line's width on the paper.
struct Tally {
  int plain = 0;          ///< rows labelled "yes" ...
  int plain_found = 0;    ///< ... and found
  int faint = 0;          ///< labelled "faint" ...
  int faint_found = 0;    ///< ... and found
  int elsewhere = 0;      ///< found more than 3 px off a visible line
  int invisible = 0;      ///< labelled "no" ...
  int false_finds = 0;    ///< ... and found something
  int mirror_finds = 0;   ///< of these the line's mirror image
  double plain_rms = 0;   ///< of the plain rows found [px]
  double plain_bias = 0;  ///< [px]
};

void count(const Label& label, const StripeProfile& profile, Tally& tally) {
  const bool found = profile.seen[label.row] != 0;
  const auto position = static_cast<double>(profile.position[label.row]);
  if (label.seen == "no") {
    ++tally.invisible;
    tally.false_finds += found ? 1 : 0;
    const bool mirror = found && label.mirror >= 0 && std::abs(position - label.mirror) < 3;
    tally.mirror_finds += mirror ? 1 : 0;
    return;
  }
  const double error = position - label.position;
  const bool on_line = found && std::abs(error) <= 3;
  tally.elsewhere += found && !on_line ? 1 : 0;
  if (label.seen == "faint") {
    ++tally.faint;
    tally.faint_found += on_line ? 1 : 0;
    return;
  }
  ++tally.plain;
  if (!on_line) return;
  ++tally.plain_found;
  tally.plain_rms += error * error;
  tally.plain_bias += error;
}

Tally tally_of(const std::filesystem::path& pictures, const StripeOptions& options) {
  Tally tally;
  for (const auto& [picture, labels] : read_labels()) {
    const Image8 image = read_image(pictures / "images" / picture);
    const StripeProfile profile = detect_stripe(image.view(), {}, options);
    for (const Label& label : labels) count(label, profile, tally);
  }
  tally.plain_rms = std::sqrt(tally.plain_rms / tally.plain_found);
  tally.plain_bias /= tally.plain_found;
  return tally;
}

void record(const Tally& tally) {
  const auto property = [](const char* name, double value) {
    std::ostringstream text;
    text << value;
    testing::Test::RecordProperty(name, text.str());
    std::cout << "  " << name << " " << text.str() << "\n";
  };
  property("plain_rows", tally.plain);
  property("plain_found", tally.plain_found);
  property("faint_rows", tally.faint);
  property("faint_found", tally.faint_found);
  property("found_elsewhere", tally.elsewhere);
  property("invisible_rows", tally.invisible);
  property("false_finds", tally.false_finds);
  property("mirror_finds", tally.mirror_finds);
  property("rms_px", tally.plain_rms);
  property("bias_px", tally.plain_bias);
}

TEST(SteelPlatesSet, TheDefaultFindsTheLineInAmbientLight) {
  FACULA_REQUIRE_REAL_DATA(pictures, "laser/ambient_steel_plates");
  const Tally tally = tally_of(pictures, {});
  record(tally);
  EXPECT_EQ(tally.plain, 310);
  EXPECT_GE(tally.plain_found, 297);
  EXPECT_LE(tally.elsewhere, 25);
  EXPECT_LE(tally.false_finds - tally.mirror_finds, 9);
  EXPECT_LT(tally.plain_rms, 0.35);
}

TEST(SteelPlatesSet, CandidatesAndHueFindMoreRowsAndFewerFalseOnes) {
  FACULA_REQUIRE_REAL_DATA(pictures, "laser/ambient_steel_plates");
  StripeOptions options;
  options.max_candidates = 4;
  options.hue = LaserHue::kRed;
  const Tally tally = tally_of(pictures, options);
  record(tally);
  EXPECT_GE(tally.plain_found, 306);
  EXPECT_LE(tally.elsewhere, 7);
  EXPECT_LE(tally.false_finds - tally.mirror_finds, 5);
  EXPECT_LE(tally.mirror_finds, 19);  // without a rig nothing tells them from the line
  EXPECT_LT(tally.plain_rms, 0.35);
}

TEST(SteelPlatesSet, TheRedChannelLiesWhereTheLabelsDo) {
  // Red excess is made of chroma, which JPEG keeps at half the resolution: positions move by a
  // sixth of a pixel. The labels were read off the red values.
  FACULA_REQUIRE_REAL_DATA(pictures, "laser/ambient_steel_plates");
  StripeOptions options;
  options.channel = Channel::kRed;
  options.max_candidates = 4;
  options.hue = LaserHue::kRed;
  const Tally tally = tally_of(pictures, options);
  record(tally);
  EXPECT_LT(tally.plain_rms, 0.2);
  EXPECT_LT(std::abs(tally.plain_bias), 0.06);
}

}  // namespace
}  // namespace facula
