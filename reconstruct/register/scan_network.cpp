// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/median.hpp>
#include <facula/reconstruct/register/scan_network.hpp>
#include <facula/reconstruct/register/twist.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <Eigen/Cholesky>

namespace facula {
namespace {

constexpr double kLeastOverlap = 0.05;  // counted as this much at least [1]

/// The edge's information after the error of whole scans was added to its pose, about the middle of
/// what both share: (I^-1 + F)^-1 = G - G (I + G)^-1 G with G = F^-1, which holds for any rank.
Matrix6 softened(const ScanEdge& edge, double scan_sigma) {
  const Matrix6 to_middle = about(edge.middle);
  // What is bent averages out over a surface: the less both share, the more of it is seen.
  const double sigma = scan_sigma / std::clamp(edge.overlap, kLeastOverlap, 1.0);
  const double shift = 1 / (sigma * sigma);
  Vector6 weight;
  weight << Eigen::Vector3d::Constant(shift),
      Eigen::Vector3d::Constant(shift * edge.radius * edge.radius);
  const Matrix6 g = to_middle.transpose() * weight.asDiagonal() * to_middle;
  const Matrix6 soft = g - g * (edge.edge.information + g).ldlt().solve(g);
  return (soft + soft.transpose()) / 2;
}

/// The lowest scan that each is joined with over the kept edges.
std::vector<std::size_t> groups_of(std::size_t scans, const std::vector<ScanEdge>& edges) {
  std::vector<std::size_t> group(scans);
  std::iota(group.begin(), group.end(), std::size_t{0});
  for (const ScanEdge& edge : edges) {
    if (edge.verdict != EdgeVerdict::kKept) continue;
    const std::size_t a = group[edge.edge.from];
    const std::size_t b = group[edge.edge.to];
    for (std::size_t& g : group) g = g == std::max(a, b) ? std::min(a, b) : g;
  }
  return group;
}

/// The group of the most scans; of equal ones the first.
std::size_t largest_group(const std::vector<std::size_t>& group) {
  std::vector<std::size_t> count(group.size());
  for (const std::size_t g : group) ++count[g];
  return static_cast<std::size_t>(std::max_element(count.begin(), count.end()) - count.begin());
}

/// Poses along the tree of those edges that overlap most, from each group's lowest scan.
std::vector<RigidTransform> tree_poses(std::vector<RigidTransform> poses,
                                       const std::vector<ScanEdge>& edges) {
  std::vector<std::size_t> best(edges.size());
  std::iota(best.begin(), best.end(), std::size_t{0});
  std::stable_sort(best.begin(), best.end(), [&](std::size_t a, std::size_t b) {
    return edges[a].overlap > edges[b].overlap;
  });
  std::vector<std::size_t> tree(poses.size());
  std::iota(tree.begin(), tree.end(), std::size_t{0});
  for (const std::size_t e : best) {
    const PoseEdge& edge = edges[e].edge;
    if (edges[e].verdict != EdgeVerdict::kKept || tree[edge.from] == tree[edge.to]) continue;
    // The tree of the higher number moves onto the other.
    const bool from_moves = tree[edge.from] > tree[edge.to];
    const RigidTransform step = from_moves ? edge.to_from_from : edge.to_from_from.inverse();
    const std::size_t moving = from_moves ? edge.from : edge.to;
    const std::size_t staying = from_moves ? edge.to : edge.from;
    const RigidTransform change = poses[staying] * step * poses[moving].inverse();
    const std::size_t old = tree[moving];
    for (std::size_t i = 0; i < tree.size(); ++i) {
      if (tree[i] != old) continue;
      poses[i] = change * poses[i];
      tree[i] = tree[staying];
    }
  }
  return poses;
}

/// The kept edges for the graph; `which` receives their numbers.
std::vector<PoseEdge> graph_edges(const std::vector<ScanEdge>& edges,
                                  double scan_sigma,
                                  std::vector<std::size_t>& which) {
  std::vector<PoseEdge> measured;
  which.clear();
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (edges[e].verdict != EdgeVerdict::kKept) continue;
    measured.push_back(edges[e].edge);
    measured.back().information = softened(edges[e], scan_sigma);
    which.push_back(e);
  }
  return measured;
}

void add_motion(const ScanMotion& motion,
                const std::vector<std::size_t>& group,
                const std::vector<RigidTransform>& poses,
                std::vector<PoseEdge>& edges) {
  if (motion.kind == ScanStand::kFree) return;
  for (std::size_t i = 0; i < group.size(); ++i) {
    const std::size_t root = group[i];
    if (root != i) edges.push_back(motion.as_edge(i, root, poses[root].inverse() * poses[i]));
  }
}

void note_residuals(const PoseGraphResult& graph,
                    const std::vector<std::size_t>& which,
                    std::vector<ScanEdge>& edges) {
  for (std::size_t k = 0; k < which.size(); ++k) {
    ScanEdge& edge = edges[which[k]];
    edge.residual = graph.edges[k];
    if (!graph.edges[k].outlier) continue;
    edge.verdict = EdgeVerdict::kOutlier;
    edge.reason = "it contradicts the other pairs";
  }
}

Matrix6 block(const ScanNetwork& network, std::size_t i, std::size_t k) {
  return network.joint_covariance.block<6, 6>(static_cast<Eigen::Index>(6 * i),
                                              static_cast<Eigen::Index>(6 * k));
}

/// Covariance of the pose of scan i against that of scan a, as a twist of the world.
Matrix6 relative_covariance(const ScanNetwork& network, std::size_t i, std::size_t a) {
  return block(network, i, i) + block(network, a, a) - block(network, i, a) - block(network, a, i);
}

/// chi2 of the kept edges over what it should be; 0 where no loop tells.
double median_excess(const std::vector<ScanEdge>& edges) {
  constexpr double kMedianOfSix = 5.348;  // of chi2 with six degrees of freedom
  std::vector<double> excess;
  for (const ScanEdge& edge : edges) {
    if (edge.verdict != EdgeVerdict::kKept || edge.residual.redundancy < 0.1) continue;
    excess.push_back(edge.residual.chi2 / (edge.residual.redundancy * kMedianOfSix));
  }
  return excess.size() < 3 ? 0.0 : median(excess);
}

/// join_scans() in the order of the poses.
ScanNetwork join_in_order(const std::vector<RigidTransform>& given,
                          std::vector<ScanEdge>& edges,
                          const RegisterScansOptions& options,
                          double scan_sigma) {
  const std::size_t count = given.size();
  std::vector<std::size_t> which;
  const std::vector<RigidTransform> start = tree_poses(given, edges);
  std::vector<PoseEdge> measured = graph_edges(edges, scan_sigma, which);
  add_motion(options.motion, groups_of(count, edges), start, measured);
  PoseGraphOptions how = options.graph;
  how.anchor = 0;
  const PoseGraphResult robust = solve_pose_graph(count, measured, start, how);
  note_residuals(robust, which, edges);

  // Once more, plain, over the edges kept: the anchor and the covariances are the group's own.
  const std::vector<std::size_t> group = groups_of(count, edges);
  const std::size_t largest = largest_group(group);
  ScanNetwork network;
  network.anchor = largest;
  const RigidTransform back = given[largest] * robust.world_from_scan[largest].inverse();
  std::vector<RigidTransform> poses = robust.world_from_scan;
  for (RigidTransform& pose : poses) pose = back * pose;
  measured = graph_edges(edges, scan_sigma, which);
  add_motion(options.motion, group, poses, measured);
  how.anchor = largest;
  how.robust = false;
  const PoseGraphResult plain = solve_pose_graph(count, measured, poses, how);
  note_residuals(plain, which, edges);
  network.covariance = plain.covariance;
  network.joint_covariance = plain.joint_covariance;
  network.chi2 = plain.chi2;
  network.degrees_of_freedom = plain.degrees_of_freedom;
  for (std::size_t i = 0; i < count; ++i) {
    network.world_from_scan.push_back(group[i] == largest ? std::optional(plain.world_from_scan[i])
                                                          : std::nullopt);
  }
  return network;
}

/// The scans by their names, of equal names by their order.
std::vector<std::size_t> by_name(const ScanProject& project) {
  std::vector<std::size_t> order(project.scans.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return project.scans[a].name < project.scans[b].name;
  });
  return order;
}

void renumber(const std::vector<std::size_t>& number, std::vector<ScanEdge>& edges) {
  for (ScanEdge& edge : edges) {
    edge.edge.from = number[edge.edge.from];
    edge.edge.to = number[edge.edge.to];
  }
}

/// The network with scan k under the number number[k].
ScanNetwork renumbered(const ScanNetwork& network, const std::vector<std::size_t>& number) {
  ScanNetwork result = network;
  result.anchor = number[network.anchor];
  for (std::size_t i = 0; i < number.size(); ++i) {
    result.world_from_scan[number[i]] = network.world_from_scan[i];
    result.covariance[number[i]] = network.covariance[i];
    for (std::size_t k = 0; k < number.size(); ++k) {
      result.joint_covariance.block<6, 6>(static_cast<Eigen::Index>(6 * number[i]),
                                          static_cast<Eigen::Index>(6 * number[k])) =
          block(network, i, k);
    }
  }
  return result;
}

}  // namespace

ScanNetwork join_scans(const ScanProject& project,
                       std::vector<ScanEdge>& edges,
                       const RegisterScansOptions& options,
                       double scan_sigma) {
  // Sums and pivots in the order of the names: the poses do not depend on the order given.
  const std::vector<std::size_t> order = by_name(project);
  std::vector<std::size_t> rank(order.size());
  std::vector<RigidTransform> given;
  for (const std::size_t i : order) {
    rank[i] = given.size();
    given.push_back(project.scans[i].world_from_scan);
  }
  renumber(rank, edges);
  const ScanNetwork network = join_in_order(given, edges, options, scan_sigma);
  renumber(order, edges);
  return renumbered(network, order);
}

std::size_t central_scan(const ReadyScans& scans, const ScanNetwork& network) {
  std::size_t best = network.anchor;
  double least = std::numeric_limits<double>::infinity();
  for (const std::size_t a : scans.order) {
    if (!network.world_from_scan[a]) continue;
    double sum = 0;
    for (const std::size_t i : scans.order) {
      if (!network.world_from_scan[i]) continue;
      const PointCloud& coarse = scans.pyramids[i]->levels.back().cloud;
      const auto moves = pose_jacobian(*network.world_from_scan[i] * middle_of(coarse));
      sum += (moves * relative_covariance(network, i, a) * moves.transpose()).trace();
    }
    if (sum < least) {
      least = sum;
      best = a;
    }
  }
  return best;
}

std::size_t first_scan(const ScanNetwork& network) {
  const auto& poses = network.world_from_scan;
  const auto placed =
      std::find_if(poses.begin(), poses.end(), [](const auto& pose) { return pose.has_value(); });
  return static_cast<std::size_t>(placed - poses.begin());
}

void move_anchor(const ScanProject& project, std::size_t anchor, ScanNetwork& network) {
  const RigidTransform change =
      project.scans[anchor].world_from_scan * network.world_from_scan[anchor]->inverse();
  const Matrix6 adjoint = adjoint_of(change);
  const ScanNetwork before = network;
  for (std::size_t i = 0; i < network.covariance.size(); ++i) {
    if (!before.world_from_scan[i]) continue;
    network.world_from_scan[i] = change * *before.world_from_scan[i];
    network.covariance[i] = adjoint * relative_covariance(before, i, anchor) * adjoint.transpose();
  }
  network.joint_covariance.resize(0, 0);  // was against the other anchor
  network.anchor = anchor;
}

double fitting_scan_sigma(const ScanProject& project,
                          const std::vector<ScanEdge>& edges,
                          const RegisterScansOptions& options,
                          const std::pair<double, double>& least_most) {
  const auto [least, most] = least_most;
  double low = least;
  double high = most;
  for (int step = 0; step < 12; ++step) {
    const double sigma = step == 0 ? least : std::sqrt(low * high);
    std::vector<ScanEdge> tried = edges;
    join_scans(project, tried, options, sigma);
    if (median_excess(tried) > 1) {
      low = sigma;
    } else if (step == 0) {
      return least;
    } else {
      high = sigma;
    }
  }
  return high;
}

}  // namespace facula
