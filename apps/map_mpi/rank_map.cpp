// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/commands/octomap_log.hpp>
#include <facula/apps/commands/posed_scans.hpp>
#include <facula/apps/map_mpi/rank_map.hpp>
#include <facula/apps/map_mpi/scan_parts.hpp>
#include <facula/map/map_folder.hpp>
#include <facula/map/scan_cells.hpp>
#include <facula/map/space_block.hpp>

#include <algorithm>
#include <chrono>
#include <utility>

namespace facula {
namespace {

using Clock = std::chrono::steady_clock;

/// Adds the time it lives to a figure.
class TimeSpent {
 public:
  explicit TimeSpent(double& seconds) : seconds_(seconds) {}
  ~TimeSpent() { seconds_ += std::chrono::duration<double>(Clock::now() - begin_).count(); }
  TimeSpent(const TimeSpent&) = delete;
  TimeSpent& operator=(const TimeSpent&) = delete;

 private:
  double& seconds_;
  Clock::time_point begin_ = Clock::now();
};

/// A scan's points in the frame of the map, as `facula map` takes them.
PointCloud open_scan(const ListedScan& listed, RankFigures& figures) {
  const TimeSpent reading(figures.reading);
  const CleanScan scan = read_clean_scan(listed);
  ++figures.scans;
  figures.points += scan.points_read;
  figures.mixed_removed += scan.mixed_removed;
  if (!scan.posed.cloud.colors.empty()) ++figures.coloured;
  return in_world(scan.posed);
}

}  // namespace

RankMap::RankMap(const Ranks& ranks, const OccupancyOptions& options)
    : ranks_(ranks), options_(options) {}

void RankMap::insert(const std::vector<ListedScan>& scans) {
  std::vector<Bytes> received;
  for (std::size_t first = 0;; first += ranks_.size()) {
    std::vector<Bytes> parts(ranks_.size());
    Clock::time_point done;
    ranks_.together([&] {
      apply(std::exchange(received, {}));
      const std::size_t mine = first + ranks_.rank();
      if (mine < scans.size()) parts = cast(scans[mine]);
      done = Clock::now();
    });
    figures_.waiting += std::chrono::duration<double>(Clock::now() - done).count();
    if (first >= scans.size()) break;
    const TimeSpent exchanging(figures_.exchanging);
    received = ranks_.exchange(parts);
  }
  count_cells();
}

std::vector<Bytes> RankMap::cast(const ListedScan& listed) {
  const PointCloud cloud = open_scan(listed, figures_);
  const TimeSpent casting(figures_.casting);
  const ScanCells cells = cells_of_scan(cloud, options_.cast());
  figures_.rays += cloud.size();
  figures_.skipped += cells.skipped;
  std::vector<Bytes> parts = parts_of_scan(cells, ranks_.size(), options_.num_threads);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    figures_.packed += parts[i].size();
    if (i != ranks_.rank()) figures_.sent += parts[i].size();
  }
  return parts;
}

void RankMap::apply(const std::vector<Bytes>& received) {
  const TimeSpent applying(figures_.applying);
  for (const Bytes& part : received) {  // by rank, which is the order of the scans of a round
    share_.apply(
        bricks_of_part(part, options_.num_threads), options_.model(), options_.num_threads);
  }
}

void RankMap::count_cells() {
  for (const LogOddsMap::Entry& entry : share_.entries()) {
    const auto occupied = static_cast<std::uint64_t>(entry.brick.occupied().count());
    figures_.occupied_cells += occupied;
    figures_.free_cells += static_cast<std::uint64_t>(entry.brick.known().count()) - occupied;
  }
  figures_.bricks = share_.entries().size();
  figures_.map_memory = share_.memory_usage();
}

std::vector<BlockRecord> RankMap::write(const std::filesystem::path& folder) {
  const TimeSpent writing(figures_.writing);
  std::vector<std::uint64_t> codes;
  for (const LogOddsMap::Entry* entry : share_.sorted()) codes.push_back(entry->code);
  std::vector<BlockRecord> records;
  for (auto code = codes.begin(); code != codes.end();) {
    const std::uint64_t block = block_of(*code);
    LogOddsMap bricks;
    for (; code != codes.end() && block_of(*code) == block; ++code) {
      bricks.find_or_add(*code) = std::move(share_.find_or_add(*code));
    }
    records.push_back(write_block(folder, block, bricks, options_.resolution));
    figures_.file_bytes += records.back().size;
  }
  share_ = {};
  figures_.blocks = records.size();
  figures_.peak_memory = peak_memory();
  return records;
}

}  // namespace facula
