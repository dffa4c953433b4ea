// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/map_mpi/rank_figures.hpp>

#include <algorithm>
#include <fstream>
#include <string>

namespace facula {
namespace {

constexpr double kMebibyte = 1 << 20;  ///< [bytes]

template <typename Field>
Field sum_of(const std::vector<RankFigures>& ranks, Field RankFigures::*field) {
  Field sum{};
  for (const RankFigures& rank : ranks) sum += rank.*field;
  return sum;
}

template <typename Field>
Field most_of(const std::vector<RankFigures>& ranks, Field RankFigures::*field) {
  Field most{};
  for (const RankFigures& rank : ranks) most = std::max(most, rank.*field);
  return most;
}

double per_scan(const std::vector<RankFigures>& ranks, std::uint64_t RankFigures::*field) {
  const auto scans = static_cast<double>(sum_of(ranks, &RankFigures::scans));
  return static_cast<double>(sum_of(ranks, field)) / std::max(1.0, scans);
}

void report_sums(const std::vector<RankFigures>& ranks, Figures& figures) {
  const auto count = [&](const char* key, const char* label, std::uint64_t RankFigures::*field) {
    figures.count(key, label, sum_of(ranks, field));
  };
  figures.count("ranks", "ranks", ranks.size());
  count("scans", "scans", &RankFigures::scans);
  count("points", "points", &RankFigures::points);
  count("mixed_removed", "mixed points removed", &RankFigures::mixed_removed);
  count("rays", "rays", &RankFigures::rays);
  count("skipped_points", "points skipped", &RankFigures::skipped);
  count("free_cells", "free cells", &RankFigures::free_cells);
  count("occupied_cells", "occupied cells", &RankFigures::occupied_cells);
  count("bricks", "bricks", &RankFigures::bricks);
  count("blocks", "files of blocks", &RankFigures::blocks);
  count("file_bytes", "bytes in them", &RankFigures::file_bytes);
  figures.number("packed_bytes_per_scan",
                 "cells of a scan, packed, bytes",
                 per_scan(ranks, &RankFigures::packed),
                 0);
  figures.number("exchanged_bytes_per_scan",
                 "of these to other ranks, bytes",
                 per_scan(ranks, &RankFigures::sent),
                 0);
}

void report_most(const std::vector<RankFigures>& ranks, Figures& figures) {
  const auto seconds = [&](const char* key, const char* label, double RankFigures::*field) {
    figures.number(key, label, most_of(ranks, field), 3);
  };
  seconds("reading_s", "reading, slowest rank", &RankFigures::reading);
  seconds("casting_s", "casting, slowest rank", &RankFigures::casting);
  seconds("waiting_s", "waiting for others, longest", &RankFigures::waiting);
  seconds("exchanging_s", "exchanging, slowest rank", &RankFigures::exchanging);
  seconds("applying_s", "applying, slowest rank", &RankFigures::applying);
  seconds("writing_s", "writing, slowest rank", &RankFigures::writing);
  figures.number("map_memory_mib",
                 "largest share of the map",
                 static_cast<double>(most_of(ranks, &RankFigures::map_memory)) / kMebibyte,
                 1);
  figures.number("peak_memory_mib",
                 "peak memory of a rank",
                 static_cast<double>(most_of(ranks, &RankFigures::peak_memory)) / kMebibyte,
                 1);
}

FigureTable table_of(const std::vector<RankFigures>& ranks) {
  FigureTable table{.key = "by_rank",
                    .title = "By rank:",
                    .columns = {{"rank", "rank"},
                                {"scans", "scans"},
                                {"rays", "rays"},
                                {"sent_bytes", "sent"},
                                {"bricks", "bricks"},
                                {"reading_s", "reading", 3},
                                {"casting_s", "casting", 3},
                                {"waiting_s", "waiting", 3},
                                {"exchanging_s", "exchanging", 3},
                                {"applying_s", "applying", 3},
                                {"writing_s", "writing", 3},
                                {"map_memory_mib", "map", 1},
                                {"peak_memory_mib", "peak memory", 1}}};
  for (std::size_t i = 0; i < ranks.size(); ++i) {
    const RankFigures& rank = ranks[i];
    std::vector<FigureValue>& row = table.rows.emplace_back();
    for (const std::uint64_t count :
         {std::uint64_t{i}, rank.scans, rank.rays, rank.sent, rank.bricks}) {
      row.emplace_back(static_cast<long long>(count));
    }
    for (const double seconds :
         {rank.reading, rank.casting, rank.waiting, rank.exchanging, rank.applying, rank.writing}) {
      row.emplace_back(seconds);
    }
    row.emplace_back(static_cast<double>(rank.map_memory) / kMebibyte);
    row.emplace_back(static_cast<double>(rank.peak_memory) / kMebibyte);
  }
  return table;
}

}  // namespace

void report_ranks(const std::vector<RankFigures>& ranks, Figures& figures) {
  report_sums(ranks, figures);
  report_most(ranks, figures);
  figures.table(table_of(ranks));
  if (sum_of(ranks, &RankFigures::coloured) == 0) return;
  figures.note("The colours of scans are left out; 'facula map' keeps them.");
}

std::uint64_t peak_memory() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    std::uint64_t kibibytes = 0;
    if (word == "VmHWM:" && status >> kibibytes) return 1024 * kibibytes;
  }
  return 0;
}

}  // namespace facula
