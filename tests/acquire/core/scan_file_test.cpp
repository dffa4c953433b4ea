// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/cloud_file.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/random.hpp>
#include <facula/acquire/core/scan_file.hpp>
#include <facula/acquire/core/whole_file.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <cstring>

namespace facula {
namespace {

/// A scan with gaps and numbers that no short text holds.
PolarScan uneven_scan() {
  Random random(11);
  PolarScan scan = PolarScan::empty(7, 5);
  for (std::size_t cell = 0; cell < scan.point.size(); ++cell) {
    if (random.below(3) == 0) continue;
    const Eigen::Vector3d p(random.normal(), random.normal(), random.normal());
    scan.set(
        cell, p, static_cast<float>(random.uniform()), static_cast<float>(random.uniform() / 1000));
  }
  for (std::size_t col = 0; col < 5; ++col) {
    scan.axis_position[col] = random.normal() / 3;
    scan.time[col] = random.uniform() * 1e9;
    scan.sensor_origin[col] = {random.normal(), random.normal() * 1e-12, -0.0};
  }
  Eigen::Matrix<double, 6, 1> twist;
  twist << 100.1, -7, 1.0 / 3, 0.3, 0.1, -2;
  scan.world_from_scan = exp_se3(twist);
  return scan;
}

template <typename T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(static_cast<const void*>(a.data()),
                                             static_cast<const void*>(b.data()),
                                             a.size() * sizeof(T)) == 0;
}

void expect_same_bits(const PolarScan& a, const PolarScan& b) {
  EXPECT_EQ(a.rows, b.rows);
  EXPECT_EQ(a.cols, b.cols);
  EXPECT_TRUE(same_bits(a.point, b.point));
  EXPECT_TRUE(same_bits(a.range, b.range));
  EXPECT_TRUE(same_bits(a.yaw, b.yaw));
  EXPECT_TRUE(same_bits(a.pitch, b.pitch));
  EXPECT_TRUE(same_bits(a.intensity, b.intensity));
  EXPECT_TRUE(same_bits(a.sigma, b.sigma));
  EXPECT_TRUE(same_bits(a.valid, b.valid));
  EXPECT_TRUE(same_bits(a.axis_position, b.axis_position));
  EXPECT_TRUE(same_bits(a.time, b.time));
  EXPECT_TRUE(same_bits(a.sensor_origin, b.sensor_origin));
  EXPECT_EQ(a.world_from_scan.translation, b.world_from_scan.translation);
  EXPECT_EQ(a.world_from_scan.rotation.coeffs(), b.world_from_scan.rotation.coeffs());
  EXPECT_EQ(a.stand, b.stand);
}

/// A small organised file by another program: 2 x 2, one gap.
std::string foreign_pcd() {
  return "# .PCD v.7\r\nVERSION .7\r\nFIELDS x y z\r\nSIZE 4 4 4\r\nTYPE F F F\r\nCOUNT 1 1 1\r\n"
         "WIDTH 2\r\nHEIGHT 2\r\nVIEWPOINT 1 2 3 2 0 0 0\r\nPOINTS 4\r\nDATA ascii\r\n"
         "1 1 0\r\n0 0 -2\r\nnan nan nan\r\n-3 0 0\r\n";
}

TEST(ScanFile, ReadsBackTheSameScanBitForBit) {
  const TemporaryFolder folder;
  const PolarScan scan = uneven_scan();
  ASSERT_GT(scan.valid_count(), 10U);
  ASSERT_LT(scan.valid_count(), 35U);
  write_scan(folder / "a.pcd", scan);
  expect_same_bits(read_scan(folder / "a.pcd"), scan);
}

TEST(ScanFile, KeepsHowTheScanStandsAndRefusesWhatItDoesNotKnow) {
  const TemporaryFolder folder;
  PolarScan scan = uneven_scan();
  write_scan(folder / "free.pcd", scan);
  EXPECT_EQ(read_whole_file(folder / "free.pcd").find("facula stand"), std::string::npos);
  for (const ScanStand stand : {ScanStand::kUpright, ScanStand::kTable}) {
    scan.stand = stand;
    write_scan(folder / "a.pcd", scan);
    expect_same_bits(read_scan(folder / "a.pcd"), scan);
  }
  std::string text = read_whole_file(folder / "a.pcd");
  text.replace(text.find("stand table"), 11, "stand askew");
  EXPECT_NE(error_of([&] { read_scan(folder.write("b.pcd", text)); }).find("stands 'askew'"),
            std::string::npos);
}

TEST(ScanFile, ReadsBackAScanOfOneRow) {
  const TemporaryFolder folder;
  PolarScan scan = PolarScan::empty(1, 3);
  scan.set(2, {1, 2, 3}, 1, 0);
  write_scan(folder / "row.pcd", scan);
  expect_same_bits(read_scan(folder / "row.pcd"), scan);
}

TEST(ScanFile, DerivesThePolarFormOfAForeignScan) {
  const TemporaryFolder folder;
  const PolarScan scan = read_scan(folder.write("foreign.pcd", foreign_pcd()));
  scan.check();
  ASSERT_EQ(scan.rows, 2);
  ASSERT_EQ(scan.cols, 2);
  EXPECT_EQ(scan.valid_count(), 3U);
  EXPECT_EQ(scan.valid[scan.index(1, 0)], 0);
  EXPECT_NEAR(scan.range[scan.index(0, 0)], std::sqrt(2), 1e-6);
  EXPECT_NEAR(scan.yaw[scan.index(0, 0)], 0.785398163, 1e-6);
  EXPECT_NEAR(scan.pitch[scan.index(0, 1)], -1.570796327, 1e-6);
  EXPECT_NEAR(scan.yaw[scan.index(1, 1)], 3.141592654, 1e-6);
  EXPECT_EQ(scan.world_from_scan.translation, Eigen::Vector3d(1, 2, 3));
  EXPECT_DOUBLE_EQ(scan.world_from_scan.rotation.w(), 1) << "a quaternion is made a unit one";
}

TEST(ScanFile, ReadsItsValidCellsAsACloud) {
  const TemporaryFolder folder;
  const PolarScan scan = uneven_scan();
  for (const char* name : {"a.pcd", "a.ply", "a.asc"}) {
    write_scan(folder / name, scan);
    const PointCloud cloud = read_cloud(folder / name);
    ASSERT_EQ(cloud.size(), scan.valid_count()) << name;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const auto& p : cloud.points) sum += p.cast<double>();
    for (const auto& p : cloud_from_scan(scan).points) sum -= p.cast<double>();
    EXPECT_LT(sum.norm(), 1e-12) << name;
  }
}

TEST(ScanFile, WritesColumnRowAndPointPerLineAsAsc) {
  const TemporaryFolder folder;
  PolarScan scan = PolarScan::empty(4, 3);
  scan.set(scan.index(3, 1), {0.5, -1, 2.25}, 1, 0);
  write_scan(folder / "a.asc", scan);
  EXPECT_EQ(read_whole_file(folder / "a.asc"), "1 3 0.5 -1 2.25\n");
}

TEST(ScanFile, SaysWhatIsWrongWithABadFile) {
  const TemporaryFolder folder;
  const auto sentence_for = [&](const std::string& from, const std::string& to) {
    std::string text = foreign_pcd();
    text.replace(text.find(from), from.size(), to);
    std::string sentence = error_of([&] { read_scan(folder.write("bad.pcd", text)); });
    EXPECT_NE(sentence.find("bad.pcd"), std::string::npos) << sentence;
    return sentence;
  };
  EXPECT_NE(sentence_for("FIELDS x y z", "FIELDS x y w").find("no field z"), std::string::npos);
  EXPECT_NE(sentence_for("WIDTH 2\r\nHEIGHT 2", "WIDTH 4\r\nHEIGHT 1").find("not an organised"),
            std::string::npos);
  EXPECT_NE(sentence_for("1 2 3 2 0", "1 2 3 0 0").find("no pose"), std::string::npos);
  EXPECT_NE(sentence_for("1 2 3 2 0 0 0", "1 2 3").find("expected 7"), std::string::npos);
  EXPECT_NE(sentence_for("# .PCD v.7", "# facula scan 1").find("no field range"),
            std::string::npos);
  EXPECT_NE(error_of([&] { read_scan(folder / "none.pcd"); }).find("no such file"),
            std::string::npos);
  EXPECT_NE(error_of([&] { read_scan(folder / "a.las"); }).find("ends in .pcd"), std::string::npos);
}

TEST(ScanFile, NoticesTornColumnComments) {
  const TemporaryFolder folder;
  write_scan(folder / "a.pcd", uneven_scan());
  const std::string whole = read_whole_file(folder / "a.pcd");
  const std::size_t begin = whole.find("# facula column 4");
  std::string missing = whole;
  missing.erase(begin, whole.find('\n', begin) + 1 - begin);
  EXPECT_NE(error_of([&] { read_scan(folder.write("b.pcd", missing)); }).find("describes 4"),
            std::string::npos);
  std::string torn = whole;
  torn.erase(whole.find('\n', begin) - 3, 3);
  torn.replace(torn.find("# facula column 4") + 18, 1, "x");
  EXPECT_NE(error_of([&] { read_scan(folder.write("c.pcd", torn)); }).find("torn comment"),
            std::string::npos);
}

TEST(ScanFile, RefusesEveryTruncation) {
  const TemporaryFolder folder;
  write_scan(folder / "a.pcd", uneven_scan());
  const std::string whole = read_whole_file(folder / "a.pcd");
  for (std::size_t length = 0; length < whole.size(); length += 13) {
    const auto path = folder.write("torn.pcd", whole.substr(0, length));
    EXPECT_THROW(read_scan(path), Error) << length << " of " << whole.size() << " bytes";
  }
}

TEST(ScanFile, WritesNothingForAWrongNameOrAnEmptyScan) {
  const TemporaryFolder folder;
  EXPECT_THROW(write_scan(folder / "a.las", uneven_scan()), Error);
  EXPECT_THROW(write_scan(folder / "a.pcd", PolarScan()), Error);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace facula
