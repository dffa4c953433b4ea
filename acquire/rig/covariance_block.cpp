// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/rig/covariance_block.hpp>

namespace facula {
namespace {

/// Appends the rows and columns of `from` that are chosen.
void append(RigCovariance& to, const RigCovariance& from, const std::vector<Eigen::Index>& chosen) {
  const Eigen::Index before = to.matrix.rows();
  const auto count = static_cast<Eigen::Index>(chosen.size());
  Eigen::MatrixXd grown = Eigen::MatrixXd::Zero(before + count, before + count);
  grown.topLeftCorner(before, before) = to.matrix;
  for (Eigen::Index r = 0; r < count; ++r) {
    to.parameters.push_back(
        from.parameters[static_cast<std::size_t>(chosen[static_cast<std::size_t>(r)])]);
    for (Eigen::Index c = 0; c < count; ++c) {
      grown(before + r, before + c) =
          from.matrix(chosen[static_cast<std::size_t>(r)], chosen[static_cast<std::size_t>(c)]);
    }
  }
  to.matrix = grown;
}

}  // namespace

void replace_covariance(Rig& rig,
                        const std::string& part,
                        const std::vector<std::string>& names,
                        const Eigen::MatrixXd& covariance) {
  require(static_cast<Eigen::Index>(names.size()) == covariance.rows() &&
              covariance.rows() == covariance.cols(),
          "expected a covariance of ",
          names.size(),
          " parameters, got one of ",
          covariance.rows(),
          " x ",
          covariance.cols());
  RigCovariance merged;
  if (rig.covariance) {
    std::vector<Eigen::Index> others;
    for (std::size_t i = 0; i < rig.covariance->parameters.size(); ++i) {
      if (!rig.covariance->parameters[i].starts_with(part)) {
        others.push_back(static_cast<Eigen::Index>(i));
      }
    }
    append(merged, *rig.covariance, others);
  }
  const RigCovariance added{names, 0.5 * (covariance + covariance.transpose())};
  std::vector<Eigen::Index> estimated;
  for (Eigen::Index i = 0; i < covariance.rows(); ++i) {
    if (covariance(i, i) > 0) estimated.push_back(i);
  }
  append(merged, added, estimated);
  rig.covariance.reset();
  if (!merged.parameters.empty()) rig.covariance = merged;
}

}  // namespace facula
