// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/scan_file.hpp>
#include <facula/reconstruct/register/scan_list.hpp>
#include <facula/reconstruct/register/scan_project.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <cmath>
#include <fstream>
#include <functional>
#include <sstream>

#include <boost/iostreams/filter/gzip.hpp>
#include <boost/iostreams/filter/lzma.hpp>
#include <boost/iostreams/filtering_stream.hpp>
#include <gtest/gtest.h>

namespace facula {
namespace {

constexpr const char* kPoints = "1 0 0\n0 2 0\n0 0 3\n";
const double kHalf = std::sqrt(0.5);

template <typename Compressor>
std::string packed(const std::string& text) {
  std::ostringstream bytes;
  {
    boost::iostreams::filtering_ostream chain;
    chain.push(Compressor());
    chain.push(bytes);
    chain << text;
  }
  return bytes.str();
}

void expect_error(const std::function<void()>& action, const std::string& words) {
  const std::string sentence = error_of(action);
  EXPECT_NE(sentence.find(words), std::string::npos) << sentence;
}

TEST(ReadScanProject, ReadsPosesAndTurnsPointsIntoTheWorld) {
  const TemporaryFolder folder;
  folder.write("a.xyz", kPoints);
  const auto file =
      folder.write("poses.toml",
                   "[[scan]]\nname = \"one\"\nfile = \"a.xyz\"\n"
                   "translation_mm = [1000, 0, -500]\n"
                   "quaternion_xyzw = [0, 0, 0.7071067811865476, 0.7071067811865476]\n"
                   "[[scan]]\nfile = \"a.xyz\"\n");
  const ScanProject project = read_scan_project(file);
  ASSERT_EQ(project.scans.size(), 2U);
  EXPECT_EQ(project.scans[0].name, "one");
  EXPECT_EQ(project.scans[1].name, "a");
  const PointCloud all = project.fused();
  ASSERT_EQ(all.size(), 6U);
  EXPECT_TRUE(is_near_point(all.points[0].cast<double>(), {1, 1, -0.5}, 1e-6));
  EXPECT_TRUE(is_near_point(all.points[1].cast<double>(), {-1, 0, -0.5}, 1e-6));
  EXPECT_TRUE(is_near_point(all.sensor_origin[0].cast<double>(), {1, 0, -0.5}, 1e-6));
  EXPECT_EQ(all.points[3], Eigen::Vector3f(1, 0, 0));
}

TEST(ReadScanProject, NamesUnknownKeysAndBadValues) {
  const TemporaryFolder folder;
  folder.write("a.xyz", kPoints);
  const auto error_with = [&](const std::string& text, const std::string& words) {
    const auto file = folder.write("poses.toml", text);
    expect_error([&] { read_scan_project(file); }, words);
  };
  error_with("[[scan]]\nfile=\"a.xyz\"\ntranslation_m=[0,0,0]\n", "did you mean 'translation_mm'");
  error_with("[[scans]]\nfile=\"a.xyz\"\n", "did you mean 'scan'");
  error_with("[[scan]]\nname=\"a\"\n", "missing the key file");
  error_with("[[scan]]\nfile=\"b.xyz\"\n", "b.xyz");
  error_with("[[scan]]\nfile=\"a.xyz\"\ntranslation_mm=[0,0]\n", "list of 3 numbers");
  error_with("[[scan]]\nfile=\"a.xyz\"\ntranslation_mm=[0,nan,0]\n", "no number");
  error_with("[[scan]]\nfile=\"a.xyz\"\nquaternion_xyzw=[0,0,0,2]\n", "length 2");
  error_with("scan = 3\n", "names no scan");
  error_with("", "names no scan");
  error_with("[[scan]\n", "line 1");
  expect_error([&] { read_scan_project(folder / "nowhere"); }, "no file or folder");
}

TEST(WritePoses, IsReadBackTheSame) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "scans");
  folder.write("scans/a.xyz", kPoints);
  ScanProject project;
  PosedCloud scan;
  scan.name = "odd \"name\" \\ \t";
  scan.file = folder / "scans/a.xyz";
  scan.world_from_scan =
      exp_se3((Eigen::Matrix<double, 6, 1>() << 1.0 / 3, -12.5, 1e-9, 0.3, -2.0, 1.1).finished());
  project.scans = {scan};
  write_poses(folder / "poses.toml", project);
  const ScanProject back = read_scan_project(folder / "poses.toml");
  ASSERT_EQ(back.scans.size(), 1U);
  EXPECT_EQ(back.scans[0].name, scan.name);
  EXPECT_EQ(std::filesystem::canonical(back.scans[0].file), std::filesystem::canonical(scan.file));
  EXPECT_TRUE(is_near_pose(back.scans[0].world_from_scan, scan.world_from_scan, 1e-14, 1e-14));
  const auto text = (std::ostringstream() << std::ifstream(folder / "poses.toml").rdbuf()).str();
  EXPECT_NE(text.find("file = \"scans/a.xyz\""), std::string::npos) << text;
}

/// A scan of two columns with its own pose and sensor origins.
PolarScan small_scan() {
  PolarScan scan = PolarScan::empty(2, 2);
  scan.world_from_scan = {Eigen::Quaterniond(kHalf, 0, 0, kHalf), {1, 2, 3}};
  for (std::size_t col = 0; col < 2; ++col) {
    scan.sensor_origin[col] = {0.1 * double(col), 0.2, 0.3};
    scan.axis_position[col] = 0.1 * double(col);
    scan.set(scan.index(0, int(col)), {1, double(col), 0}, 0.5F, 0.001F);
  }
  return scan;
}

TEST(ListScans, OpensNoFileOfPoints) {
  const TemporaryFolder folder;
  const auto file = folder.write("poses.toml",
                                 "[[scan]]\nfile = \"a.xyz\"\nname = \"first\"\n"
                                 "translation_mm = [1000, 0, 0]\n[[scan]]\nfile = \"b.xyz.gz\"\n");
  const std::vector<ListedScan> scans = list_scans(file);
  ASSERT_EQ(scans.size(), 2U);
  EXPECT_EQ(scans[0].name, "first");
  EXPECT_EQ(scans[1].name, "b");
  EXPECT_EQ(scans[1].file, folder / "b.xyz.gz");
  expect_error([&] { scans[0].read(); }, "a.xyz");
  folder.write("a.xyz", kPoints);
  const PosedCloud scan = scans[0].read();
  EXPECT_EQ(scan.name, "first");
  EXPECT_GT(scan.cloud.size(), 0U);
  EXPECT_EQ(scan.world_from_scan.translation.x(), 1.0);
}

TEST(WritePoses, StatesTheCovarianceOfAPose) {
  const TemporaryFolder folder;
  folder.write("a.xyz", kPoints);
  const auto file = folder.write("poses.toml", "[[scan]]\nfile = \"a.xyz\"\n");
  ScanProject project = read_scan_project(file);
  EXPECT_TRUE(project.scans[0].pose_covariance.isZero(0));
  Eigen::Matrix<double, 6, 6> root;
  for (Eigen::Index i = 0; i < 36; ++i) root(i / 6, i % 6) = 1e-3 * std::sin(1.0 + double(i * i));
  project.scans[0].pose_covariance = root * root.transpose();
  write_poses(file, project);
  EXPECT_TRUE(read_scan_project(file).scans[0].pose_covariance.isApprox(
      project.scans[0].pose_covariance, 1e-15));
  project.scans[0].pose_covariance(2, 2) = INFINITY;  // no direction may be told as sure
  write_poses(file, project);
  EXPECT_TRUE(read_scan_project(file).scans[0].pose_covariance.isZero(0));
}

TEST(ReadScanProject, RefusesACovarianceOfNothing) {
  const TemporaryFolder folder;
  folder.write("a.xyz", kPoints);
  const std::string entry = "[[scan]]\nfile = \"a.xyz\"\ncovariance_m_rad = ";
  expect_error([&] { read_scan_project(folder.write("poses.toml", entry + "[1, 2]\n")); },
               "list of 21 numbers");
  const std::string negative =
      "[-1e-6, 0,0,0,0,0, 1e-6, 0,0,0,0, 1e-6, 0,0,0, 1e-8, 0,0, 1e-8, 0, 1e-8]\n";
  expect_error([&] { read_scan_project(folder.write("poses.toml", entry + negative)); },
               "negative variance");
  const std::string impossible =  // shifts that correlate by 2
      "[1e-6, 2e-6,0,0,0,0, 1e-6, 0,0,0,0, 1e-6, 0,0,0, 1e-8, 0,0, 1e-8, 0, 1e-8]\n";
  expect_error([&] { read_scan_project(folder.write("poses.toml", entry + impossible)); },
               "negative variance");
}

TEST(ReadScanProject, TakesTheViewpointOfAPcdUnlessPosesSayOtherwise) {
  const TemporaryFolder folder;
  const PolarScan scan = small_scan();
  write_scan(folder / "a.pcd", scan);
  const ScanProject alone = read_scan_project(folder / "a.pcd");
  ASSERT_EQ(alone.scans.size(), 1U);
  EXPECT_EQ(alone.scans[0].name, "a");
  ASSERT_EQ(alone.scans[0].cloud.size(), 2U);
  EXPECT_TRUE(is_near_pose(alone.scans[0].world_from_scan, scan.world_from_scan, 1e-12, 1e-12));
  EXPECT_TRUE(
      is_near_point(alone.scans[0].cloud.sensor_origin[1].cast<double>(), {0.1, 0.2, 0.3}, 1e-6));
  const auto poses = folder.write("poses.toml",
                                  "[[scan]]\nfile=\"a.pcd\"\ntranslation_mm=[7000, 0, 0]\n"
                                  "[[scan]]\nfile=\"a.pcd\"\n");
  const ScanProject both = read_scan_project(poses);
  EXPECT_TRUE(is_near_pose(
      both.scans[0].world_from_scan, {Eigen::Quaterniond::Identity(), {7, 0, 0}}, 1e-12, 1e-12));
  EXPECT_TRUE(is_near_pose(both.scans[1].world_from_scan, scan.world_from_scan, 1e-12, 1e-12));
}

TEST(ReadScanProject, KnowsHowScansStandWhereAllSayTheSame) {
  const TemporaryFolder folder;
  PolarScan scan = small_scan();
  const auto stand_with = [&](ScanStand second) {
    scan.stand = ScanStand::kUpright;
    write_scan(folder / "a.pcd", scan);
    scan.stand = second;
    write_scan(folder / "b.pcd", scan);
    return read_scan_project(
               folder.write("poses.toml", "[[scan]]\nfile=\"a.pcd\"\n[[scan]]\nfile=\"b.pcd\"\n"))
        .stand();
  };
  EXPECT_EQ(stand_with(ScanStand::kUpright), ScanStand::kUpright);
  EXPECT_EQ(stand_with(ScanStand::kFree), ScanStand::kFree);
  EXPECT_EQ(stand_with(ScanStand::kTable), ScanStand::kFree);
  EXPECT_EQ(ScanProject{}.stand(), ScanStand::kFree);
}

TEST(ReadScanProject, UnpacksGzAndXz) {
  const TemporaryFolder folder;
  folder.write("a.xyz.gz", packed<boost::iostreams::gzip_compressor>(kPoints));
  folder.write("b.xyz.xz", packed<boost::iostreams::lzma_compressor>(kPoints));
  for (const char* name : {"a.xyz.gz", "b.xyz.xz"}) {
    const ScanProject project = read_scan_project(folder / name);
    EXPECT_EQ(project.scans.at(0).name, std::string(name, 1));
    EXPECT_EQ(project.scans.at(0).cloud.size(), 3U);
  }
  const auto poses = folder.write("poses.toml", "[[scan]]\nfile=\"a.xyz\"\n");
  EXPECT_EQ(read_scan_project(poses).scans.at(0).cloud.size(), 3U);
}

TEST(ReadScanProject, RefusesPackedFilesThatAreCutShortOrNotPacked) {
  const TemporaryFolder folder;
  std::string text;
  for (int i = 0; i < 2000; ++i) text += std::to_string(i * i % 977) + " 1 2\n";
  const std::string gz = packed<boost::iostreams::gzip_compressor>(text);
  const std::string xz = packed<boost::iostreams::lzma_compressor>(text);
  for (const double share : {0.0, 0.01, 0.3, 0.7, 0.999}) {
    folder.write("cut.xyz.gz", gz.substr(0, std::size_t(share * double(gz.size()))));
    folder.write("cut.xyz.xz", xz.substr(0, std::size_t(share * double(xz.size()))));
    EXPECT_NE(error_of([&] { read_scan_project(folder / "cut.xyz.gz"); }), "") << share;
    EXPECT_NE(error_of([&] { read_scan_project(folder / "cut.xyz.xz"); }), "") << share;
  }
  folder.write("plain.xyz.gz", text);
  expect_error([&] { read_scan_project(folder / "plain.xyz.gz"); }, "cannot unpack");
}

TEST(ReadScanProject, TurnsTheConjugateQuaternionOfAStanfordConf) {
  const TemporaryFolder folder;
  folder.write("a.xyz", kPoints);
  // (0, 0, s, s) turns x to y by 90 degrees; the file's convention is the inverse turn.
  const auto file = folder.write("two.conf",
                                 "camera 1 2 3 0 0 0 1\n\nmesh ignored\n"
                                 "bmesh a.xyz 0.5 0 0 0 0 0.70710678 0.70710678\r\n");
  const ScanProject project = read_scan_project(file);
  ASSERT_EQ(project.scans.size(), 1U);
  EXPECT_TRUE(is_near_point(
      project.scans[0].world_from_scan * Eigen::Vector3d(1, 0, 0), {0.5, -1, 0}, 1e-7));
  const auto torn = folder.write("torn.conf", "bmesh a.xyz 0.5 0 0 0 0 x 1\n");
  expect_error([&] { read_scan_project(torn); }, "line 1");
  const auto none = folder.write("none.conf", "camera 1 2 3\n");
  expect_error([&] { read_scan_project(none); }, "names no scan");
}

TEST(ReadScanProject, Turns3dtkToMetresAndZUp) {
  const TemporaryFolder folder;
  folder.write("scan000.3d", "100 20 300\n0 0 0\n1000 0 4000\n10 0 0\n");
  folder.write("scan000.pose", "10 20 30\n0 90 0\n");
  folder.write("config.ini", "max=3276 # cm\nmin=48 # cm\n");
  folder.write("scan000.frames", "ignored");
  const ScanProject project = read_scan_project(folder.path());
  ASSERT_EQ(project.scans.size(), 1U);
  ASSERT_EQ(project.scans[0].cloud.size(), 1U);
  // x right, y up, z ahead becomes x ahead, y left, z up.
  EXPECT_TRUE(is_near_point(project.scans[0].cloud.points[0].cast<double>(), {3, -1, 0.2}, 1e-6));
  // In the file's frame the turn by 90 degrees takes (100, 20, 300) to (300, 20, -100).
  EXPECT_TRUE(is_near_point(
      project.fused().points[0].cast<double>(), {-1 + 0.3, -3 - 0.1, 0.2 + 0.2}, 1e-6));
  folder.write("scan000.pose", "10 20 30\n0 90\n");
  expect_error([&] { read_scan_project(folder.path()); }, "5 numbers");
  folder.write("scan000.pose", "0 0 0 0 0 0");
  folder.write("scan000.3d", "100 20 300\n7 7");
  expect_error([&] { read_scan_project(folder.path()); }, "three for every point");
  const TemporaryFolder bare;
  expect_error([&] { read_scan_project(bare.path()); }, "neither");
}

}  // namespace
}  // namespace facula
