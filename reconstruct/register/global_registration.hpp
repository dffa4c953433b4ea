// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/reconstruct/register/global_features.hpp>
#include <facula/reconstruct/register/pair_registration.hpp>
#include <facula/reconstruct/register/pose_score.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace facula {

enum class Verdict : std::uint8_t {
  kAccepted,   ///< one pose explains both scans and no other comes near it
  kAmbiguous,  ///< several poses explain them about equally well
  kRefused,    ///< no pose explains them
};
const char* to_string(Verdict verdict);

/// Where the candidates of a pose come from.
enum class GlobalMethod : std::uint8_t { kAuto, kFeatures, kPlanes };

struct GlobalOptions {
  GlobalMethod method = GlobalMethod::kAuto;  ///< kAuto tries planes where a scan has enough
  std::uint64_t seed = 1;                     ///< of every random draw [1]
  double min_overlap = 0.15;  ///< least share of the smaller scan that must meet the other [0..1]
  int max_candidates = 12;    ///< poses refined and judged [1], at least 2
  PairOptions refinement;
  int num_threads = 0;  ///< 0 = all cores; the result does not depend on it [1]

  void check() const;
};

struct GlobalResult {
  Verdict verdict = Verdict::kRefused;
  std::string reason;  ///< one sentence for people, with the figures that decided
  PairResult pair;     ///< refined best pose; meaningful unless refused
  PoseScore score;
  std::vector<PairResult> rivals;  ///< poses nearly as good, best first (kAmbiguous)
};

/// Registers two scans of any pose: candidates from features (FPFH, Rusu 2009) or from triples of
/// planes, refined by register_pair() and judged. The seed fixes the result.
GlobalResult register_without_guess(const ScanPyramid& source,
                                    const ScanPyramid& target,
                                    const GlobalOptions& options = {});

/// The same for scans made ready once for many pairs, with features of one voxel.
GlobalResult register_without_guess(const GlobalFeatures& source,
                                    const GlobalFeatures& target,
                                    const GlobalOptions& options = {});

}  // namespace facula
