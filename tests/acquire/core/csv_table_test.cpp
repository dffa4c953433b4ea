// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/csv_table.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <numbers>
#include <string>

#include <gtest/gtest.h>

namespace facula {
namespace {

TEST(CsvTable, ReadsColumnsByNameInTheLibrarysUnits) {
  const TemporaryFolder folder;
  const auto file = folder.write(
      "t.csv",
      "# a comment, with commas\r\npixel_px, distance_mm ,yaw_deg\r\n1,1000,180\n\n2,5e2,-90\n");
  const CsvTable table = CsvTable::from_file(file);
  EXPECT_EQ(table.rows(), 2U);
  EXPECT_TRUE(table.has("yaw_deg"));
  EXPECT_EQ(table.column({"position_px", "pixel_px"}), (std::vector<double>{1, 2}));
  EXPECT_EQ(table.column({"distance_mm"}), (std::vector<double>{1, 0.5}));
  EXPECT_NEAR(table.column({"yaw_deg"})[0], std::numbers::pi, 1e-15);
  EXPECT_EQ(table.texts("distance_mm"), (std::vector<std::string>{"1000", "5e2"}));
}

TEST(CsvTable, TakesTheMarkThatSpreadsheetsWriteFirst) {
  const TemporaryFolder folder;
  const auto file = folder.write("t.csv",
                                 "\xEF\xBB\xBF"
                                 "distance_mm,b\r\n5,2\r\n");
  EXPECT_EQ(CsvTable::from_file(file).column({"distance_mm"}), std::vector<double>{0.005});
}

TEST(CsvTable, SaysWhereItCannotRead) {
  const TemporaryFolder folder;
  const auto said = [&](const std::string& text) {
    const auto file = folder.write("t.csv", text);
    return error_of([&] { CsvTable::from_file(file).column({"a_px"}); });
  };
  EXPECT_NE(said("").find("an empty table"), std::string::npos);
  EXPECT_NE(said("# only\n").find("an empty table"), std::string::npos);
  EXPECT_NE(said("a_px;b\n1;2\n").find("expected commas"), std::string::npos);
  EXPECT_NE(said("a_px,b\n").find("the header alone"), std::string::npos);
  EXPECT_NE(said("a_px,b\n1,2\n3\n").find("line 3: expected 2 cells"), std::string::npos);
  EXPECT_NE(said("a_px,b\n1,2\nx,4\n").find("line 3: expected a finite number in column a_px"),
            std::string::npos);
  EXPECT_NE(said("a_px,b\nnan,2\n").find("got 'nan'"), std::string::npos);
  EXPECT_NE(said("b,c\n1,2\n").find("a column called a_px, got the columns b, c"),
            std::string::npos);
  EXPECT_NE(error_of([&] { CsvTable::from_file(folder / "none.csv"); }).find("none.csv"),
            std::string::npos);
}

}  // namespace
}  // namespace facula
