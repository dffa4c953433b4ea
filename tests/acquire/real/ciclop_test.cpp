// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/capture/capture_file.hpp>
#include <facula/acquire/capture/frame_source.hpp>
#include <facula/tests/support/real_data.hpp>

#include <gtest/gtest.h>

namespace facula {
namespace {

StripeProfile profile_of(const std::filesystem::path& frames, bool background) {
  const Capture capture = read_capture(shipped_data("captures/ciclop_bust_and_pattern"), frames);
  const CaptureFrames source(capture);
  return detect_stripe(
      source.lit(0).view(), background ? source.dark(0).view() : ImageView8{}, capture.stripe);
}

/// Rows that show the line: on the bust from its plume to its base, and on the table's rim (read
/// off the picture). Elsewhere there is nothing to find.
bool shows_line(std::size_t row) {
  return (row >= 52 && row <= 1122) || row >= 1221;
}

TEST(CiclopSet, FindsTheLineOnTheBustInRoomLight) {
  FACULA_REQUIRE_REAL_DATA(frames, "laser/ciclop_bust_and_pattern");
  const StripeProfile profile = profile_of(frames, true);
  std::size_t on_line = 0;
  std::size_t elsewhere = 0;
  for (std::size_t r = 0; r < profile.size(); ++r) {
    if (profile.seen[r] == 0) continue;
    // The line runs within a band of the picture; a find beside it is false.
    const bool in_band = profile.position[r] > 480 && profile.position[r] < 800;
    (shows_line(r) && in_band ? on_line : elsewhere) += 1;
  }
  RecordProperty("rows_on_line", static_cast<int>(on_line));
  RecordProperty("rows_elsewhere", static_cast<int>(elsewhere));
  EXPECT_GE(on_line, 1050U);
  EXPECT_LE(elsewhere, 25U);
}

}  // namespace
}  // namespace facula
