// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/text_numbers.hpp>
#include <facula/reconstruct/register/undecided_directions.hpp>

#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>

namespace facula {
namespace {

/// Normals that oppose a motion by less than this, in the mean square, do not decide it: 1e-3 is
/// one surface in a thousand that faces the motion squarely, or all of them 2 degrees askew.
constexpr double kLeastShape = 1e-3;

/// The basis of the same space whose first vectors slide most and turn least.
Eigen::Matrix<double, 6, Eigen::Dynamic> slides_first(
    const Eigen::Matrix<double, 6, Eigen::Dynamic>& basis) {
  if (basis.cols() == 0) return basis;
  const Eigen::JacobiSVD<Eigen::Matrix<double, 3, Eigen::Dynamic>> svd(basis.topRows<3>(),
                                                                       Eigen::ComputeFullV);
  Eigen::Matrix<double, 6, Eigen::Dynamic> sorted = basis * svd.matrixV();
  for (Eigen::Index c = 0; c < sorted.cols(); ++c) {
    Eigen::Index largest = 0;
    sorted.col(c).cwiseAbs().maxCoeff(&largest);
    if (sorted(largest, c) < 0) sorted.col(c) = -sorted.col(c).eval();
  }
  return sorted;
}

/// The three numbers in brackets, rounded to multiples of `step`.
std::string triple(const Eigen::Vector3d& v, double step) {
  std::string text = "(";
  for (int i = 0; i < 3; ++i) {
    if (i > 0) text += ", ";
    text += number_text(std::round(v(i) / step) / std::round(1 / step) + 0.0);
  }
  text += ')';
  return text;
}

}  // namespace

DecidedMotions decided_motions(const PairSystem& system) {
  const Eigen::SelfAdjointEigenSolver<Matrix6> solver(system.shape);
  Eigen::Index open = 0;  // eigenvalues rise
  while (open < 6 && !(solver.eigenvalues()(open) >= kLeastShape)) ++open;
  return {solver.eigenvectors().rightCols(6 - open),
          slides_first(solver.eigenvectors().leftCols(open))};
}

std::string motion_in_words(const Vector6& twist, const PairSystem& system) {
  const Eigen::Vector3d slide = twist.head<3>();
  const Eigen::Vector3d turn = twist.tail<3>() / system.radius;
  // Turning so little that the overlap's own points move eight times farther by the slide.
  if (twist.tail<3>().norm() < 0.125) return "slides along " + triple(slide.normalized(), 0.01);
  // The axis of a screw motion lies where the velocity is along the turn (Chasles).
  const Eigen::Vector3d through = system.pivot + turn.cross(slide) / turn.squaredNorm();
  return "turns about " + triple(turn.normalized(), 0.01) + " through " +
         triple(1000 * through, 0.1) + " mm";
}

}  // namespace facula
