// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/progress.hpp>
#include <facula/reconstruct/register/global_registration.hpp>
#include <facula/reconstruct/register/pose_graph.hpp>
#include <facula/reconstruct/register/scan_motion.hpp>
#include <facula/reconstruct/register/scan_project.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace facula {

/// Where registration starts.
enum class ScanStart : std::uint8_t {
  kAuto,    ///< from the given poses when they differ from each other, else from nothing
  kGiven,   ///< from the given poses
  kNothing  ///< from nothing, whatever poses are given
};

struct RegisterScansOptions {
  ScanStart start = ScanStart::kAuto;
  ScanMotion motion = {};       ///< how the scans may lie to each other
  PyramidOptions pyramid = {};  ///< of every scan
  GlobalOptions global = {};    ///< of the search from nothing; its seed fixes the result
  PairOptions refinement = {};  ///< of pairs; max_distance holds for a start from given poses
  PoseGraphOptions graph = {};  ///< its anchor is not used, see register_scans()
  double min_overlap = 0.15;    ///< pairs that share less are not registered [0..1]
  int num_threads = 0;          ///< 0 = all cores; the result does not depend on it [1]
  Progress progress = {};       ///< called per pair; may be empty

  void check() const;
};

/// What became of a pair of scans.
enum class EdgeVerdict : std::uint8_t {
  kKept,     ///< part of the poses found
  kOutlier,  ///< contradicts the others
  kRefused   ///< no pose was found that both scans bear out
};
const char* to_string(EdgeVerdict verdict);

/// A pair of scans that was registered.
struct ScanEdge {
  PoseEdge edge;  ///< indices are those of the project's scans
  EdgeVerdict verdict = EdgeVerdict::kRefused;
  std::string reason;     ///< of the verdict, for people
  double overlap = 0;     ///< share of the smaller scan that meets the other [0..1]
  double inlier_rms = 0;  ///< point to plane [m]
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();  ///< of what both share, target frame [m]
  double radius = 0;                                 ///< of the same, rms about its middle [m]
  EdgeResidual residual;  ///< against the poses found; nothing where refused
};

/// What became of a scan.
struct ScanPlacement {
  bool placed = false;
  std::string reason;     ///< why it was refused; empty when placed
  std::size_t edges = 0;  ///< kept edges it takes part in [1]
  double checked = 0;     ///< greatest redundancy of these; 0 = one edge holds it alone [0..1]
  double overlap = 0;     ///< share of its points that lie on another placed scan [0..1]
  /// Of the twist e in true pose = exp_se3(e) * estimate, against the anchor.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
};

struct RegisterScansResult {
  std::size_t anchor = 0;  ///< the scan that stays where it is
  bool from_given = false;
  std::vector<ScanEdge> edges;       ///< ordered by scan
  std::vector<ScanPlacement> scans;  ///< one per scan of the project
  std::size_t placed = 0;            ///< [1]
  double chi2 = 0;                   ///< of the kept edges [1]
  int degrees_of_freedom = 0;        ///< of that chi2 [1]
  /// What scans have wrong as a whole, 1 standard deviation: added to the pairs' own covariances so
  /// that the residuals of loops are as large as they should be [m].
  double scan_sigma = 0;
};

/// Finds the poses of all scans, from nothing or from given poses: registers every pair, joins the
/// pairs in a pose graph that gives up wrong ones, registers all pairs that overlap once more from
/// there, checks every scan against all others, and fits the points of all pairs at once. Poses of
/// placed scans and their covariances are updated; a scan that cannot be placed keeps its pose and
/// is refused with the reason. One scan keeps its pose: from given poses the first of the largest
/// group, from nothing the one against which the others are known best. The result does not depend
/// on the order of the scans where their names differ (but for that first one). Throws Error when
/// fewer than two scans can be used.
RegisterScansResult register_scans(ScanProject& project, const RegisterScansOptions& options = {});

}  // namespace facula
