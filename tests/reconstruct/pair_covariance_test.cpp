// SPDX-License-Identifier: GPL-3.0-or-later
// A part of tests/bench/covariance_study.cpp: does the stated covariance hold on simulated pairs?
#include <facula/reconstruct/register/pair_registration.hpp>
#include <facula/tests/reconstruct/simulated_pair.hpp>

#include <cmath>
#include <string>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

namespace facula {
namespace {

constexpr int kPairs = 40;

struct Way {
  PairMethod method;
  bool with_sigma;
};

class PairCovariance : public testing::TestWithParam<Way> {};

TEST_P(PairCovariance, HoldsTheTrueErrorInItsBounds) {
  double sum = 0;
  int inside = 0;
  for (int i = 0; i < kPairs; ++i) {
    SimulatedPair pair =
        simulate_pair({.seed = 1000 + static_cast<std::uint64_t>(i), .rows = 60, .cols = 160});
    if (!GetParam().with_sigma) {
      pair.source.cloud.sigma.clear();
      pair.target.cloud.sigma.clear();
    }
    const RigidTransform guess =
        exp_se3(
            (Eigen::Matrix<double, 6, 1>() << 0.05, -0.04, 0.03, 0.02, -0.02, 0.03).finished()) *
        pair.target_from_source;
    const PairResult result = register_pair(build_pyramid(pair.source),
                                            build_pyramid(pair.target),
                                            guess,
                                            {.method = GetParam().method});
    const Eigen::Matrix<double, 6, 1> error =
        log_se3(pair.target_from_source * result.target_from_source.inverse());
    const double nees = error.dot(result.covariance.ldlt().solve(error));
    sum += nees;
    // 2.5 % and 97.5 % of chi squared with 6 degrees of freedom.
    if (nees > 1.237 && nees < 14.449) ++inside;
    EXPECT_LT(nees, 40) << "pair " << i;
  }
  RecordProperty("mean_nees", std::to_string(sum / kPairs));
  RecordProperty("inside", inside);
  // Of 40 honest pairs, 38 lie inside; fewer than 34 has a chance of 1.4 %.
  EXPECT_GE(inside, 34) << "mean " << sum / kPairs;
  EXPECT_NEAR(sum / kPairs, 6, 2.5);
}

INSTANTIATE_TEST_SUITE_P(Methods,
                         PairCovariance,
                         testing::Values(Way{PairMethod::kGeneralized, true},
                                         Way{PairMethod::kPointToPlane, true},
                                         Way{PairMethod::kGeneralized, false},
                                         Way{PairMethod::kPointToPlane, false}));

}  // namespace
}  // namespace facula
