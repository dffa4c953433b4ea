// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/reconstruct/register/ready_scans.hpp>
#include <facula/reconstruct/register/register_scans.hpp>

#include <cstddef>
#include <functional>
#include <mutex>
#include <vector>

namespace facula {

/// Counts the steps of several stages into one progress; may be called from several threads.
class StageProgress {
 public:
  StageProgress(const Progress& progress, std::size_t total);
  void add(std::size_t steps);

 private:
  const Progress& progress_;
  std::size_t total_;
  std::size_t done_ = 0;
  std::mutex mutex_;
};

/// Registers every pair from nothing. Edges come in the order of scans.pairs(), refused ones too.
std::vector<ScanEdge> search_pairs(const ReadyScans& scans,
                                   const RegisterScansOptions& options,
                                   StageProgress& progress);

/// A guess of a scan's pose in the world; none where nothing is known.
using PoseGuesses = std::vector<std::optional<RigidTransform>>;

/// How pairs are registered from guesses.
struct GuessedPairs {
  PairOptions pair;
  double reach = 0;      ///< how far off points may be by the guess [m]; 0 = by the coarse voxel
  double tolerance = 0;  ///< how far the result may move points from the guess [m]; 0 = no bound
};

/// Registers every pair whose scans overlap by their guesses. Pairs that do not are left out.
std::vector<ScanEdge> register_guessed(const ReadyScans& scans,
                                       const PoseGuesses& world_from_scan,
                                       const GuessedPairs& how,
                                       const RegisterScansOptions& options,
                                       StageProgress& progress);

}  // namespace facula
