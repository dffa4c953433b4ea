// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/cli/arguments.hpp>
#include <facula/apps/commands/register_figures.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace facula {
namespace {

double worst_sigma(const Eigen::Matrix<double, 6, 6>& covariance, int first) {
  const auto block = covariance.diagonal().segment<3>(first);
  return std::sqrt(std::max(0.0, block.maxCoeff()));
}

FigureTable placed_scans(const ScanProject& project,
                         const std::vector<RigidTransform>& before,
                         const RegisterScansResult& result) {
  FigureTable table{"scans",
                    "Scans placed:",
                    {{"name", "scan", 0},
                     {"moved_by_mm", "moved by", 2},
                     {"turned_by_deg", "turned by", 4},
                     {"position_sigma_mm", "sigma", 4},
                     {"angle_sigma_deg", "sigma", 5},
                     {"pairs", "pairs", 0},
                     {"checked_percent", "checked", 0},
                     {"overlap_percent", "overlap", 1}},
                    {}};
  for (std::size_t i = 0; i < result.scans.size(); ++i) {
    const ScanPlacement& place = result.scans[i];
    if (!place.placed) continue;
    const RigidTransform& found = project.scans[i].world_from_scan;
    table.rows.push_back({project.scans[i].name,
                          1000 * (found.translation - before[i].translation).norm(),
                          rotation_angle(before[i].inverse() * found) / kDegrees.factor,
                          1000 * worst_sigma(place.covariance, 0),
                          worst_sigma(place.covariance, 3) / kDegrees.factor,
                          static_cast<long long>(place.edges),
                          100 * place.checked,
                          100 * place.overlap});
  }
  return table;
}

FigureTable pairs(const ScanProject& project, const RegisterScansResult& result) {
  FigureTable table{"pairs",
                    "Pairs of scans:",
                    {{"from", "from", 0},
                     {"to", "to", 0},
                     {"overlap_percent", "overlap", 1},
                     {"rms_mm", "rms", 3},
                     {"off_by_mm", "off by", 3},
                     {"off_by_deg", "off by", 4},
                     {"chi2", "chi2", 1},
                     {"verdict", "verdict", 0}},
                    {}};
  for (const ScanEdge& edge : result.edges) {
    if (edge.verdict == EdgeVerdict::kRefused) continue;
    table.rows.push_back({project.scans[edge.edge.from].name,
                          project.scans[edge.edge.to].name,
                          100 * edge.overlap,
                          1000 * edge.inlier_rms,
                          1000 * edge.residual.translation,
                          edge.residual.rotation / kDegrees.factor,
                          edge.residual.chi2,
                          std::string(to_string(edge.verdict))});
  }
  return table;
}

FigureTable refused_scans(const ScanProject& project, const RegisterScansResult& result) {
  FigureTable table{
      "refused", "Scans refused:", {{"name", "scan", 0}, {"reason", "reason", 0}}, {}};
  for (std::size_t i = 0; i < result.scans.size(); ++i) {
    if (result.scans[i].placed) continue;
    table.rows.push_back({project.scans[i].name, result.scans[i].reason});
  }
  return table;
}

}  // namespace

void report_registration(const ScanProject& project,
                         const std::vector<RigidTransform>& before,
                         const RegisterScansResult& result,
                         Figures& figures) {
  const std::size_t refused_pairs = static_cast<std::size_t>(
      std::count_if(result.edges.begin(), result.edges.end(), [](const ScanEdge& edge) {
        return edge.verdict == EdgeVerdict::kRefused;
      }));
  figures.count("scan_count", "scans", project.scans.size());
  figures.count("placed", "placed", result.placed);
  figures.count("refused_count", "refused", project.scans.size() - result.placed);
  figures.text("fixed_scan", "fixed", project.scans[result.anchor].name);
  figures.text("start", "start", result.from_given ? "the poses given" : "nothing");
  figures.count("pairs_without_pose", "pairs without a pose", refused_pairs);
  figures.number("chi2", "chi2 of the pairs", result.chi2, 1);
  figures.count("degrees_of_freedom",
                "its degrees of freedom",
                static_cast<std::size_t>(std::max(0, result.degrees_of_freedom)));
  figures.number("scan_sigma_mm", "error of whole scans", 1000 * result.scan_sigma, 4);
  figures.table(pairs(project, result));
  figures.table(placed_scans(project, before, result));
  if (result.placed < project.scans.size()) figures.table(refused_scans(project, result));
}

}  // namespace facula
