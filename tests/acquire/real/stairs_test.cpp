// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/capture/capture_file.hpp>
#include <facula/acquire/triangulate/extract_scan.hpp>
#include <facula/tests/support/real_data.hpp>

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

namespace facula {
namespace {

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Median height [m] of the cells in columns [first, last] and rows 210..335.
double height(const PolarScan& scan, int first, int last) {
  std::vector<double> z;
  for (int col = first; col <= last; ++col) {
    for (int row = 210; row <= 335; ++row) {
      const std::size_t cell = scan.index(row, col);
      if (scan.valid[cell] != 0) z.push_back(static_cast<double>(scan.point[cell].z()));
    }
  }
  EXPECT_GT(z.size(), 1000U);
  return median(z);
}

TEST(StairsSet, AgreesWithTheCalipers) {
  FACULA_REQUIRE_REAL_DATA(frames, "laser/printerbed_1mm_stairs");
  const Capture capture = read_capture(shipped_data("captures/printerbed_1mm_stairs"), frames);
  const ExtractResult result = extract_scan(capture);
  EXPECT_NEAR(height(result.scan, 11, 23), 4.69e-3, 0.15e-3);
  EXPECT_NEAR(height(result.scan, 28, 41), 9.63e-3, 0.15e-3);
  EXPECT_NEAR(height(result.scan, 45, 59), 14.55e-3, 0.15e-3);
}

/// The NOTE of the set puts the offset between the runs at 2 px in the early frames and 0.4 px at
/// the end. Left in, it would cost 0.4 mm.
TEST(StairsSet, FindsTheShiftBetweenTheRuns) {
  FACULA_REQUIRE_REAL_DATA(frames, "laser/printerbed_1mm_stairs");
  const Capture capture = read_capture(shipped_data("captures/printerbed_1mm_stairs"), frames);
  const std::vector<double> shift = extract_scan(capture).zero_line_shift;
  ASSERT_EQ(shift.size(), 65U);
  EXPECT_NEAR(shift.front(), 2.0, 0.3);
  EXPECT_NEAR(shift.back(), 0.4, 0.3);

  Capture ignored = capture;
  ignored.zero_line.reset();
  const double with_shift = height(extract_scan(ignored).scan, 11, 23);
  EXPECT_GT(std::abs(with_shift - 4.69e-3), 0.2e-3) << "this test could not tell";
}

}  // namespace
}  // namespace facula
