// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/parallel.hpp>
#include <facula/reconstruct/register/joint_refinement.hpp>
#include <facula/reconstruct/register/pair_system.hpp>
#include <facula/reconstruct/register/undecided_directions.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>

namespace facula {
namespace {

constexpr int kMostRounds = 30;
constexpr double kSettledVoxels = 1e-3;  // done when no scan's points move more [voxels]
constexpr double kFarthestVoxels = 2;    // of a counterpart, as pairs end [voxels]
constexpr double kDamping = 1e-9;        // of the normal equations with a unit diagonal [1]
constexpr std::size_t kMinPairs = 12;

/// One direction of a pair of scans: the points of one, each with the nearest of the other.
struct Link {
  std::size_t source = 0;
  std::size_t target = 0;
  double bound = 0;  // farthest counterpart [m]
  PairFinder finder;
};

/// What is known of two scans' poses, for a twist of the source in the world.
struct Term {
  std::size_t source = 0;
  std::size_t target = 0;
  Matrix6 hessian = Matrix6::Zero();
  Vector6 gradient = Vector6::Zero();
};

/// What a twist of the world does, as a twist of the target's frame about the pivot.
Matrix6 into_target(const RigidTransform& target_from_world, const Eigen::Vector3d& pivot) {
  return adjoint_of({target_from_world.rotation, target_from_world.translation - pivot});
}

Term term_of(const ScanNetwork& network, const PairOptions& how, Link& link) {
  const RigidTransform target_from_world = network.world_from_scan[link.target]->inverse();
  const RigidTransform pose = target_from_world * *network.world_from_scan[link.source];
  const std::vector<PointPair> pairs = link.finder.find(pose, link.bound);
  Term term{link.source, link.target};
  if (pairs.size() < kMinPairs) return term;
  const PairSystem system = assemble(pairs, how);
  // Motions that the shape does not decide are left to the other pairs.
  Vector6 unit;
  unit << 1, 1, 1, Eigen::Vector3d::Constant(1 / system.radius);
  const auto decided = decided_motions(system).decided;
  const Matrix6 keep =
      unit.asDiagonal() * decided * decided.transpose() * unit.cwiseInverse().asDiagonal();
  const Matrix6 into = keep * into_target(target_from_world, system.pivot);
  const double weight = 1 / (system.scale * system.scale);
  term.hessian = weight * into.transpose() * system.hessian * into;
  term.gradient = weight * into.transpose() * system.gradient;
  return term;
}

/// How the scanner moves, of scan i against the anchor.
Term motion_term(const ScanNetwork& network, const ScanMotion& motion, std::size_t i) {
  const RigidTransform anchor_from_world = network.world_from_scan[network.anchor]->inverse();
  const RigidTransform pose = anchor_from_world * *network.world_from_scan[i];
  const PoseEdge edge = motion.as_edge(i, network.anchor, pose);
  const Vector6 off = log_se3(pose * edge.to_from_from.inverse());
  const Matrix6 into = into_target(anchor_from_world, Eigen::Vector3d::Zero());
  return {i,
          network.anchor,
          into.transpose() * edge.information * into,
          into.transpose() * edge.information * off};
}

std::vector<Term> all_terms(const ReadyScans& scans,
                            const ScanNetwork& network,
                            const RegisterScansOptions& options,
                            const PairOptions& how,
                            std::vector<Link>& links) {
  std::vector<Term> terms(links.size());
  parallel_for(links.size(),
               [&](std::size_t begin, std::size_t end) {
                 for (std::size_t k = begin; k < end; ++k)
                   terms[k] = term_of(network, how, links[k]);
               },
               {.num_threads = options.num_threads, .chunk = 1});
  if (options.motion.kind == ScanStand::kFree) return terms;
  for (const std::size_t i : scans.order) {
    if (i == network.anchor || !network.world_from_scan[i]) continue;
    terms.push_back(motion_term(network, options.motion, i));
  }
  return terms;
}

/// Twists in the world of the scans in the order of scans.order; the anchor's is 0.
Eigen::VectorXd common_step(const ReadyScans& scans,
                            const std::vector<Term>& terms,
                            std::size_t anchor) {
  std::vector<Eigen::Index> column(scans.pyramids.size());
  for (std::size_t k = 0; k < scans.order.size(); ++k) {
    column[scans.order[k]] = static_cast<Eigen::Index>(6 * k);
  }
  const auto all = static_cast<Eigen::Index>(6 * scans.order.size());
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(all, all);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(all);
  for (const Term& term : terms) {
    const Eigen::Index a = column[term.source];
    const Eigen::Index b = column[term.target];
    normal.block<6, 6>(a, a) += term.hessian;
    normal.block<6, 6>(b, b) += term.hessian;
    normal.block<6, 6>(a, b) -= term.hessian;
    normal.block<6, 6>(b, a) -= term.hessian;
    right.segment<6>(a) -= term.gradient;
    right.segment<6>(b) += term.gradient;
  }
  normal.middleRows<6>(column[anchor]).setZero();
  normal.middleCols<6>(column[anchor]).setZero();
  right.segment<6>(column[anchor]).setZero();
  // Unknowns of different units become pure numbers; what nothing measures stays.
  const Eigen::VectorXd scale =
      normal.diagonal().unaryExpr([](double x) { return x > 0 ? 1 / std::sqrt(x) : 0.0; });
  normal = scale.asDiagonal() * normal * scale.asDiagonal();
  normal.diagonal().array() += kDamping;
  return scale.asDiagonal() * normal.ldlt().solve(scale.asDiagonal() * right);
}

/// Both directions of every kept pair.
std::vector<Link> links_of(const ReadyScans& scans,
                           const std::vector<ScanEdge>& edges,
                           const ScanNetwork& network,
                           const PairOptions& how) {
  std::vector<Link> links;
  const auto add = [&](std::size_t source, std::size_t target) {
    const ScanPyramid& a = *scans.pyramids[source];
    const ScanPyramid& b = *scans.pyramids[target];
    const bool sided = a.oriented && b.oriented;
    links.push_back({source,
                     target,
                     kFarthestVoxels * std::max(a.levels.front().voxel, b.levels.front().voxel),
                     PairFinder(a.levels.front(), b.levels.front(), sided, how)});
  };
  for (const ScanEdge& edge : edges) {
    const auto& [from, to] = std::pair(edge.edge.from, edge.edge.to);
    if (edge.verdict != EdgeVerdict::kKept) continue;
    if (!network.world_from_scan[from] || !network.world_from_scan[to]) continue;
    add(from, to);
    add(to, from);
  }
  return links;
}

/// Moves the scans; how far the points of any moved, in its finest voxels, is returned.
double take_step(const ReadyScans& scans, const Eigen::VectorXd& step, ScanNetwork& network) {
  double most = 0;
  for (std::size_t k = 0; k < scans.order.size(); ++k) {
    const std::size_t i = scans.order[k];
    if (!network.world_from_scan[i]) continue;
    const Vector6 twist = step.segment<6>(static_cast<Eigen::Index>(6 * k));
    const RigidTransform before = *network.world_from_scan[i];
    network.world_from_scan[i] = exp_se3(twist) * before;
    const ScanPyramid& scan = *scans.pyramids[i];
    const double moved = (network.world_from_scan[i]->translation - before.translation).norm() +
                         twist.tail<3>().norm() * scan.diameter;
    most = std::max(most, moved / scan.levels.front().voxel);
  }
  return most;
}

}  // namespace

void refine_jointly(const ReadyScans& scans,
                    const std::vector<ScanEdge>& edges,
                    const RegisterScansOptions& options,
                    ScanNetwork& network) {
  PairOptions how = options.refinement;
  how.num_threads = 1;
  std::vector<Link> links = links_of(scans, edges, network, how);
  for (int round = 0; round < kMostRounds; ++round) {
    const std::vector<Term> terms = all_terms(scans, network, options, how, links);
    const Eigen::VectorXd step = common_step(scans, terms, network.anchor);
    if (take_step(scans, step, network) < kSettledVoxels) return;
  }
}

}  // namespace facula
