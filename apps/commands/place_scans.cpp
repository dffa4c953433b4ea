// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/apps/commands/place_scans.hpp>
#include <facula/reconstruct/register/register_scans.hpp>

#include <algorithm>
#include <utility>
#include <vector>

namespace facula {
namespace {

bool same_pose(const RigidTransform& a, const RigidTransform& b) {
  return a.rotation.coeffs() == b.rotation.coeffs() && a.translation == b.translation;
}

bool have_poses(const ScanProject& project) {
  const RigidTransform& first = project.scans.front().world_from_scan;
  return std::any_of(project.scans.begin(), project.scans.end(), [&](const PosedCloud& scan) {
    return !same_pose(scan.world_from_scan, first);
  });
}

}  // namespace

void place_scans(PosedScans& scans, const std::string& how, Session& session) {
  ScanProject& project = scans.project;
  if (project.scans.size() < 2 || how == "never") return;
  if (how == "auto" && have_poses(project)) return;
  RegisterScansOptions options;
  options.motion.kind = project.stand();
  options.num_threads = session.num_threads;
  options.progress = session.progress("registering scans");
  const RegisterScansResult result = register_scans(project, options);
  std::vector<PosedCloud> placed;
  for (std::size_t i = 0; i < result.scans.size(); ++i) {
    PosedCloud& scan = project.scans[i];
    if (result.scans[i].placed) {
      placed.push_back(std::move(scan));
    } else {
      session.figures.note("'" + scan.name + "' was left out: " + result.scans[i].reason);
    }
  }
  require(placed.size() >= 2,
          "the scans have no poses, and no two of them could be registered with each other; give "
          "poses (poses.toml), or look at the reasons with 'facula register'");
  session.figures.count("registered", "scans registered", placed.size());
  session.figures.count("left_out", "scans left out", project.scans.size() - placed.size());
  project.scans = std::move(placed);
}

}  // namespace facula
