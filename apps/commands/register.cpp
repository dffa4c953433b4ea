// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/apps/cli/output_path.hpp>
#include <facula/apps/commands/posed_scans.hpp>
#include <facula/apps/commands/register.hpp>
#include <facula/reconstruct/register/register_project.hpp>

#include <algorithm>
#include <cmath>
#include <memory>

namespace facula {
namespace {

struct RegisterArguments {
  std::vector<std::filesystem::path> scans;
  std::filesystem::path out;
  RegisterOptions options;
};

void declare(Arguments& arguments, RegisterArguments& a) {
  arguments.inputs("SCANS",
                   a.scans,
                   "poses.toml, a Stanford .conf, a folder of 3DTK scans, or two and more scan "
                   "files; the first scan stays where it is");
  arguments.required();
  arguments.output("--out", a.out, "the poses found (.toml), which names the scans");
  arguments.required();
  arguments.number("--voxel-mm", a.options.voxel, kMillimetres, "clouds are thinned to this first");
  arguments.number("--max-distance-mm",
                   a.options.icp.max_distance,
                   kMillimetres,
                   "farthest apart that two points of the same surface lie at the start");
  arguments.whole("--max-iterations", a.options.icp.max_iterations, "of every registration");
}

double worst_sigma(const Eigen::Matrix<double, 6, 6>& covariance, int first) {
  const auto block = covariance.diagonal().segment<3>(first);
  return std::sqrt(std::max(0.0, block.maxCoeff()));
}

std::vector<FigureValue> row(const PosedCloud& scan,
                             const RigidTransform& before,
                             const IcpResult& result) {
  const RigidTransform moved = before.inverse() * scan.world_from_scan;
  return {scan.name,
          1000 * (scan.world_from_scan.translation - before.translation).norm(),
          rotation_angle(moved) / kDegrees.factor,
          1000 * result.rms,
          100 * result.overlap,
          static_cast<long long>(result.inliers),
          1000 * worst_sigma(result.covariance, 0),
          worst_sigma(result.covariance, 3) / kDegrees.factor,
          static_cast<long long>(result.iterations),
          result.converged};
}

FigureTable empty_table() {
  return {"scans",
          "Scans moved onto the ones before them:",
          {{"name", "scan", 0},
           {"moved_by_mm", "moved by", 2},
           {"turned_by_deg", "turned by", 4},
           {"rms_mm", "rms", 3},
           {"overlap_percent", "overlap", 1},
           {"inliers", "inliers", 0},
           {"position_sigma_mm", "sigma", 4},
           {"angle_sigma_deg", "sigma", 5},
           {"iterations", "steps", 0},
           {"converged", "converged", 0}},
          {}};
}

void run(const RegisterArguments& a, Session& session) {
  check_output(a.out, {".toml"});
  ScanProject project = read_posed_scans(a.scans).project;
  require(project.scans.size() >= 2,
          "expected two scans or more, got ",
          project.scans.size(),
          "; name another scan");
  std::vector<RigidTransform> before;
  for (const PosedCloud& scan : project.scans) before.push_back(scan.world_from_scan);
  RegisterOptions options = a.options;
  options.icp.num_threads = session.num_threads;
  options.progress = session.progress("registering scans");
  const std::vector<IcpResult> results = register_project(project, options);
  write_poses(a.out, project);
  FigureTable table = empty_table();
  for (std::size_t i = 0; i < results.size(); ++i) {
    table.rows.push_back(row(project.scans[i + 1], before[i + 1], results[i]));
  }
  session.figures.count("scan_count", "scans", project.scans.size());
  session.figures.text("fixed_scan", "fixed", project.scans.front().name);
  session.figures.text("out", "written", a.out.string());
  session.figures.table(std::move(table));
}

}  // namespace

Command register_command() {
  const auto a = std::make_shared<RegisterArguments>();
  const std::string simulate =
      "facula simulate data/scenes/furnished_room.toml --rig data/rigs/head_fs1500.toml "
      "--step-deg 6 ";
  return {
      .name = "register",
      .summary = "move scans onto each other",
      .description =
          "Moves every scan after the first onto those before it by point-to-plane ICP, starting "
          "from the poses the files hold, and writes all poses. The sigmas follow from the "
          "residuals; they do not know of errors that all points share.",
      .examples = {simulate + "--position-mm -1500 -300 1100 --out here",
                   simulate + "--position-mm 200 800 1100 --out there",
                   "facula extract here --out here.pcd",
                   "facula extract there --out there.pcd",
                   "facula register here.pcd there.pcd --voxel-mm 100 --out poses.toml"},
      .declare = [a](Arguments& arguments) { declare(arguments, *a); },
      .run = [a](Session& session) { run(*a, session); }};
}

}  // namespace facula
