// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/apps/map_mpi/scan_parts.hpp>
#include <facula/map/space_block.hpp>
#include <facula/tests/map/random_scans.hpp>
#include <facula/tests/support/matchers.hpp>

#include <algorithm>

namespace facula {
namespace {

ScanCells sample_cells() {
  PointCloud cloud = random_scan(5, 3000);
  cloud.sigma.assign(cloud.size(), 0.01F);
  return cells_of_scan(cloud, {.resolution = 0.03, .weigh_sigma = true});
}

TEST(ScanParts, GiveEveryBrickToItsOwnerOnce) {
  const ScanCells cells = sample_cells();
  ASSERT_GT(cells.bricks.size(), 1000U);
  for (std::size_t owners = 1; owners <= 5; ++owners) {
    std::vector<ScanBrick> all;
    const std::vector<Bytes> parts = parts_of_scan(cells, owners, 1);
    ASSERT_EQ(parts.size(), owners);
    for (std::size_t i = 0; i < owners; ++i) {
      const std::vector<ScanBrick> part = bricks_of_part(parts[i], 2);
      for (const ScanBrick& brick : part) {
        EXPECT_EQ(owner_of_block(block_of(brick.code), owners), i);
      }
      all.insert(all.end(), part.begin(), part.end());
    }
    // Bricks of one code stay with their owner in their order, so this brings back the scan's.
    std::stable_sort(all.begin(), all.end(), [](const ScanBrick& a, const ScanBrick& b) {
      return a.code < b.code;
    });
    EXPECT_TRUE(all == cells.bricks) << owners;
  }
}

TEST(ScanParts, AreTheSameForAnyNumberOfThreads) {
  const ScanCells cells = sample_cells();
  EXPECT_EQ(parts_of_scan(cells, 3, 1), parts_of_scan(cells, 3, 2));
}

TEST(ScanParts, OfNothingAreEmpty) {
  for (const Bytes& part : parts_of_scan({}, 3, 1)) EXPECT_TRUE(part.empty());
  EXPECT_TRUE(bricks_of_part({}, 1).empty());
}

TEST(ScanParts, AreRefusedWhenTorn) {
  const Bytes part = parts_of_scan(sample_cells(), 1, 1)[0];
  const auto head = [&](std::size_t size) { return ByteView(part).first(size); };
  EXPECT_NE(error_of([&] { bricks_of_part(head(part.size() - 1), 1); }), "");
  EXPECT_NE(error_of([&] { bricks_of_part(head(3), 1); }), "");
}

}  // namespace
}  // namespace facula
