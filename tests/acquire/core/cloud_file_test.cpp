// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/cloud_file.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/whole_file.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/real_data.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <cmath>
#include <fstream>
#include <limits>
#include <utility>

namespace facula {
namespace {

PointCloud full_cloud() {
  PointCloud cloud;
  cloud.points = {{1.1F, -0.0F, 1e-30F}, {3.3333333F, 2, 0}, {-5, 6, 7}};
  cloud.normals = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  cloud.colors = {{255, 0, 1}, {200, 128, 64}, {0, 0, 255}};
  cloud.intensity = {0.1F, 0.2F, 1};
  cloud.sigma = {1e-3F, 2e-3F, 0};
  cloud.sensor_origin = {{0, 0, 1}, {0, 0, 2}, {0.1F, 0, 3}};
  return cloud;
}

std::string big_endian_float(float value) {
  std::uint32_t bits = 0;
  static_assert(sizeof(bits) == sizeof(value));
  std::copy_n(reinterpret_cast<const char*>(&value), 4, reinterpret_cast<char*>(&bits));
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(bits >> shift & 255U);
  return bytes;
}

struct BadFile {
  const char* name;
  std::string text;
  const char* expected;  ///< part of the sentence
};

void expect_sentences(const std::vector<BadFile>& files) {
  const TemporaryFolder folder;
  for (const BadFile& file : files) {
    const auto path = folder.write(file.name, file.text);
    const std::string sentence = error_of([&] { read_cloud(path); });
    EXPECT_NE(sentence.find(path.string()), std::string::npos) << sentence;
    EXPECT_NE(sentence.find(file.expected), std::string::npos) << sentence;
    EXPECT_EQ(sentence.find('\n'), std::string::npos) << sentence;
  }
}

TEST(CloudFile, ReadsBackEveryAttribute) {
  const TemporaryFolder folder;
  const PointCloud cloud = full_cloud();
  for (const char* name : {"a.ply", "a.pcd", "A.PLY"}) {
    write_cloud(folder / name, cloud);
    const PointCloud read = read_cloud(folder / name);
    read.check();
    EXPECT_EQ(read.points, cloud.points) << name;
    EXPECT_EQ(read.normals, cloud.normals) << name;
    EXPECT_EQ(read.colors, cloud.colors) << name;
    EXPECT_EQ(read.intensity, cloud.intensity) << name;
    EXPECT_EQ(read.sigma, cloud.sigma) << name;
    EXPECT_EQ(read.sensor_origin, cloud.sensor_origin) << name;
  }
}

TEST(CloudFile, ReadsBackTheSamePointsFromText) {
  const TemporaryFolder folder;
  write_cloud(folder / "a.xyz", full_cloud());
  EXPECT_EQ(read_cloud(folder / "a.xyz").points, full_cloud().points);
}

TEST(CloudFile, DropsPointsThatAreNotFinite) {
  const TemporaryFolder folder;
  PointCloud cloud = full_cloud();
  cloud.points[1].y() = std::nanf("");
  cloud.points[2].z() = std::numeric_limits<float>::infinity();
  for (const char* name : {"a.ply", "a.pcd", "a.xyz"}) {
    write_cloud(folder / name, cloud);
    const PointCloud read = read_cloud(folder / name);
    read.check();
    EXPECT_EQ(read.size(), 1U) << name;
  }
}

TEST(CloudFile, SkipsOtherPlyElementsAndDosLineEnds) {
  const TemporaryFolder folder;
  const auto path =
      folder.write("a.ply",
                   "ply\r\nformat ascii 1.0\r\nobj_info num_cols 2\r\n"
                   "element range_grid 3\r\nproperty list uchar int vertex_indices\r\n"
                   "element vertex 2\r\nproperty float x\r\nproperty double y\r\n"
                   "property float z\r\nproperty uchar intensity\r\nend_header\r\n"
                   "1 0\r\n0\r\n1 1\r\n1 2 3 51\r\n4 5 6 255");
  const PointCloud cloud = read_cloud(path);
  ASSERT_EQ(cloud.size(), 2U);
  EXPECT_EQ(cloud.points[1], Eigen::Vector3f(4, 5, 6));
  EXPECT_FLOAT_EQ(cloud.intensity[0], 0.2F);
  EXPECT_FLOAT_EQ(cloud.intensity[1], 1);
}

TEST(CloudFile, ReadsBigEndianPly) {
  const TemporaryFolder folder;
  std::string text =
      "ply\nformat binary_big_endian 1.0\nelement range_grid 2\nproperty list uchar short i\n"
      "element vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
  text += {2, 1, 2, 3, 4, 0};
  text += big_endian_float(1.5F) + big_endian_float(-2) + big_endian_float(1e9F);
  EXPECT_EQ(read_cloud(folder.write("a.ply", text)).points[0], Eigen::Vector3f(1.5F, -2, 1e9F));
}

TEST(CloudFile, ReadsTextWithColumnNamesRemarksAndCommas) {
  const TemporaryFolder folder;
  const auto csv = folder.write("a.csv", "x,y,z,grey\n# remark\n1,2,3,9\n\n+4;-5e-1;6\n");
  EXPECT_EQ(read_cloud(csv).points[1], Eigen::Vector3f(4, -0.5F, 6));
  const auto asc = folder.write("a.asc", "17 3 1 2 3\n18 4 4 5 6\n");
  EXPECT_EQ(read_cloud(asc).points[0], Eigen::Vector3f(1, 2, 3));
}

TEST(CloudFile, ReadsAColourThatAFloatHides) {
  const TemporaryFolder folder;
  const auto path = folder.write("a.pcd",
                                 "VERSION 0.7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F F\n"
                                 "WIDTH 1\nHEIGHT 1\nDATA ascii\n1 2 3 4.2108e+06\n");
  // 4210800 = 2^22 + 16496, and half a unit is the last bit of a float there: 0x4A8080E0.
  EXPECT_EQ(read_cloud(path).colors[0], (Color{0x80, 0x80, 0xE0}));
}

TEST(CloudFile, SaysWhatIsWrongWithABadPly) {
  const std::string head = "ply\nformat ascii 1.0\nelement vertex ";
  const std::string xyz = "\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
  const std::string binary =
      "ply\nformat binary_little_endian 1.0\nelement vertex 2" + xyz + std::string(20, 'a');
  expect_sentences(
      {{"empty.ply", "", "is not a PLY file"},
       {"other.ply", "solid thing\n", "is not a PLY file"},
       {"endless.ply", head + "1\n", "no end_header"},
       {"torn.ply", head + "3" + xyz + "1 2 3\n4 5 6\n", "ends before the 3 rows"},
       {"row.ply", head + "2" + xyz + "1 2 3\n4 5\n", "ends before the 2 rows"},
       {"many.ply", head + "1" + xyz + "1 2 3\n4 5 6\n", "more values than its PLY header"},
       {"word.ply", head + "1" + xyz + "1 two 3\n", "'two' where element 'vertex'"},
       {"count.ply", head + "-1" + xyz, "the count '-1'"},
       {"huge.ply", head + "18446744073709551615" + xyz + "1 2 3\n", "ends before the"},
       {"bintorn.ply", binary, "ends before the 2 rows"},
       {"binmore.ply", binary + "12345", "more values than"},
       {"zero.ply", head + "0" + xyz, "no valid points"},
       {"type.ply", head + "1\nproperty quad x\nend_header\n1\n", "type 'quad'"},
       {"noz.ply", head + "1\nproperty float x\nend_header\n1\n", "lacks one of the columns x y z"},
       {"format.ply", "ply\nformat odd 1.0\nend_header\n", "the format 'odd'"},
       {"noformat.ply", "ply\nelement vertex 1" + xyz + "1 2 3\n", "names no format"},
       {"element.ply", "ply\nformat ascii 1.0\nend_header\n", "no element 'vertex'"},
       {"early.ply", "ply\nformat ascii 1.0\nproperty int a\n", "before any element"},
       {"list.ply",
        "ply\nformat ascii 1.0\nelement f 1\nproperty list char int a\nend_header\n-4 1\n",
        "a list 'a' of -4"},
       {"listhuge.ply",
        "ply\nformat ascii 1.0\nelement f 1\nproperty list uint int a\nend_header\n4e9 1\n",
        "ends before the 1 rows"}});
}

TEST(CloudFile, SaysWhatIsWrongWithABadPcd) {
  const auto pcd = [](const std::string& size, const std::string& data) {
    return "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n" + size + "\n" + data;
  };
  const std::string two = "WIDTH 2\nHEIGHT 1\nPOINTS 2";
  std::string packed_wrong(8, '\0');
  packed_wrong[0] = 4;
  packed_wrong[4] = 24;
  expect_sentences(
      {{"empty.pcd", "", "no line DATA"},
       {"torn.pcd", pcd(two, "DATA ascii\n1 2 3\n4 5"), "does not hold the data of the 2 points"},
       {"more.pcd", pcd(two, "DATA ascii\n1 2 3 4 5 6 7"), "holds more values"},
       {"word.pcd", pcd(two, "DATA ascii\n1 2 3 four 5 6"), "'four' where the field x"},
       {"bin.pcd", pcd(two, "DATA binary\n" + std::string(23, 'a')), "the file is torn"},
       {"binmore.pcd", pcd(two, "DATA binary\n" + std::string(26, 'a')), "2 bytes more"},
       {"points.pcd", pcd("WIDTH 2\nHEIGHT 2\nPOINTS 5", "DATA ascii\n"), "contradicts itself"},
       {"huge.pcd",
        pcd("WIDTH 4294967296\nHEIGHT 4294967296\nPOINTS 0", "DATA ascii\n1 2 3"),
        "contradicts itself"},
       {"large.pcd", pcd("WIDTH 999999999999\nHEIGHT 1", "DATA binary\nabc"), "the file is torn"},
       {"negative.pcd", pcd("WIDTH -2\nHEIGHT 1", "DATA ascii\n1 2 3"), "expected a whole number"},
       {"width.pcd", pcd("HEIGHT 1", "DATA ascii\n1 2 3"), "no line WIDTH"},
       {"encoding.pcd", pcd(two, "DATA morse\n"), "the encoding 'morse'"},
       {"lzf.pcd", pcd(two, "DATA binary_compressed\n" + packed_wrong + "abcd"), "unpacked"},
       {"lzfshort.pcd", pcd(two, "DATA binary_compressed\nabc"), "the file is torn"},
       {"none.pcd", pcd("WIDTH 0\nHEIGHT 1\nPOINTS 0", "DATA ascii\n"), "no valid points"},
       {"nan.pcd", pcd("WIDTH 1\nHEIGHT 1", "DATA ascii\nnan nan nan\n"), "no valid points"},
       {"sizes.pcd", "FIELDS x y z\nSIZE 4 4\nTYPE F F F\nDATA ascii\n", "gives 2 sizes"},
       {"type.pcd", "FIELDS x\nSIZE 3\nTYPE F\nDATA ascii\n", "type F and size 3"},
       {"counts.pcd",
        "FIELDS x\nSIZE 4\nTYPE F\nCOUNT 99999999999\nWIDTH 1\nDATA ascii\n1",
        "a COUNT of"}});
}

TEST(CloudFile, SaysWhatIsWrongWithABadText) {
  expect_sentences({{"a.xyz", "1 2 3\n4 5\n", "line 2 of"},
                    {"b.xyz", "1 2 3\n4 five 6\n", "'five' as its value 2"},
                    {"c.asc", "1 2 3\n", "col row x y z"},
                    {"d.txt", "\n\n", "no valid points"},
                    {"e.xyz", "x y z\nmore words here\n", "line 2 of"},
                    {"f.las", "1 2 3\n", "expected a name that ends in"}});
}

TEST(CloudFile, TakesNoOtherColumnsForPoints) {
  const TemporaryFolder folder;
  for (const char* names : {"plane,normal_x,normal_y", "id,x,y,z", "range_mm,pan_deg,tilt_deg"}) {
    std::ofstream(folder.path() / "other.csv") << names << "\n1,2,3,4\n";
    EXPECT_NE(
        error_of([&] { read_cloud(folder.path() / "other.csv"); }).find("expected the columns"),
        std::string::npos)
        << names;
  }
  for (const char* names : {"x_m,y_m,z_m", "X Y Z", "\"Points:0\",\"Points:1\",\"Points:2\""}) {
    std::ofstream(folder.path() / "points.csv") << names << "\n1,2,3\n";
    EXPECT_EQ(read_cloud(folder.path() / "points.csv").size(), 1U) << names;
  }
}

TEST(CloudFile, SurvivesEveryTruncationOfABinaryFile) {
  const TemporaryFolder folder;
  for (const char* name : {"a.ply", "a.pcd"}) {
    write_cloud(folder / name, full_cloud());
    const std::string whole = read_whole_file(folder / name);
    for (std::size_t length = 0; length < whole.size(); ++length) {
      const auto path = folder.write(std::string("torn_") + name, whole.substr(0, length));
      EXPECT_THROW(read_cloud(path), Error) << length << " of " << whole.size() << " bytes";
    }
  }
}

TEST(CloudFile, RefusesFoldersAndMissingFiles) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "a.ply");
  EXPECT_NE(error_of([&] { read_cloud(folder / "a.ply"); }).find("not a file"), std::string::npos);
  EXPECT_NE(error_of([&] { read_cloud(folder / "b.ply"); }).find("no such file"),
            std::string::npos);
  EXPECT_THROW(write_cloud(folder / "c.ply", PointCloud()), Error);
  EXPECT_THROW(write_cloud(folder / "c.doc", full_cloud()), Error);
}

TEST(CloudFile, ReadsCompressedPcdOfOthers) {
  FACULA_REQUIRE_REAL_DATA(path, "range/pcl-data/room_scan1.pcd");
  EXPECT_EQ(read_cloud(path).size(), 112586U);
}

TEST(CloudFile, ReadsTheStanfordBunny) {
  FACULA_REQUIRE_REAL_DATA(path, "range/stanford-bunny/reconstruction/bun_zipper.ply");
  const PointCloud cloud = read_cloud(path);
  EXPECT_EQ(cloud.size(), 35947U);  // as its header and Stanford's page say
  EXPECT_EQ(cloud.intensity.size(), 35947U);
}

}  // namespace
}  // namespace facula
