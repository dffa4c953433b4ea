// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/known_sigma.hpp>
#include <facula/reconstruct/measure/primitive_fit.hpp>
#include <facula/reconstruct/measure/unexplained_variance.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace facula {
namespace {

constexpr double kLeastCosine = 0.087;  // as plane fits: no ray is more grazing than 85 degrees
constexpr int kWeightingRounds = 4;     // as plane fits

struct Sample {
  Eigen::Vector3d x;
  Eigen::Vector3d ray = Eigen::Vector3d::Zero();  // from the sensor; zero where it is not known
  double sigma = 0;                               // along the ray [m], 0 = none

  double sigma_along(const Eigen::Vector3d& normal) const {
    if (ray.isZero(0)) return sigma;
    return sigma * std::max(kLeastCosine, std::abs(ray.dot(normal)));
  }
};

std::vector<Sample> samples_of(const PointCloud& cloud, const std::vector<std::size_t>& indices) {
  cloud.check();
  std::vector<Sample> samples;
  bool all_have_sigma = !cloud.sigma.empty();
  for (const std::size_t i : indices) {
    require(i < cloud.size(), "expected points of a cloud of ", cloud.size(), ", got number ", i);
    if (!cloud.points[i].allFinite()) continue;
    Sample sample{cloud.points[i].cast<double>()};
    if (!cloud.sensor_origin.empty()) {
      sample.ray = (sample.x - cloud.sensor_origin[i].cast<double>()).normalized();
      if (!sample.ray.allFinite()) sample.ray.setZero();
    }
    all_have_sigma = all_have_sigma && is_known_sigma(cloud.sigma[i]);
    if (all_have_sigma) sample.sigma = cloud.sigma[i];
    samples.push_back(sample);
  }
  if (!all_have_sigma) {
    for (Sample& sample : samples) sample.sigma = 0;
  }
  return samples;
}

/// Normal equations at the model's place.
struct System {
  Eigen::MatrixXd information;
  Eigen::VectorXd right;
  double cost = 0;  // sum of weighted squares
};

System system_at(const std::vector<Sample>& samples,
                 const std::vector<double>& weight,
                 const PrimitiveModel& model) {
  const int n = model.parameters();
  System system{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n)};
  Eigen::VectorXd gradient(n);
  Eigen::Vector3d normal;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double d = model.distance(samples[i].x, normal, gradient);
    system.information += weight[i] * gradient * gradient.transpose();
    system.right -= weight[i] * d * gradient;
    system.cost += weight[i] * d * d;
  }
  return system;
}

/// Distances from the model, squared, and what the sigmas state of them along the normals.
struct Distances {
  std::vector<double> squares;    // [m^2]
  std::vector<double> variances;  // [m^2]
  double least = std::numeric_limits<double>::infinity();
  double most = -std::numeric_limits<double>::infinity();
};

Distances distances_from(const std::vector<Sample>& samples, const PrimitiveModel& model) {
  Distances distances;
  Eigen::VectorXd gradient(model.parameters());
  Eigen::Vector3d normal;
  for (const Sample& sample : samples) {
    const double d = model.distance(sample.x, normal, gradient);
    distances.squares.push_back(d * d);
    distances.variances.push_back(std::pow(sample.sigma_along(normal), 2));
    distances.least = std::min(distances.least, d);
    distances.most = std::max(distances.most, d);
  }
  return distances;
}

/// 1 / variance of every point along the normal, with what the sigmas leave unexplained.
std::vector<double> weights_at(const std::vector<Sample>& samples, const PrimitiveModel& model) {
  Distances distances = distances_from(samples, model);
  const std::size_t freedom = samples.size() - static_cast<std::size_t>(model.parameters());
  const double added = unexplained_variance(distances.squares, distances.variances, freedom);
  for (double& variance : distances.variances) variance = 1 / (variance + added);
  return std::move(distances.variances);
}

/// One accepted step of Levenberg and Marquardt; returns by how much of itself the cost fell, or a
/// negative number when no step lowers it.
double improve(const std::vector<Sample>& samples,
               const std::vector<double>& weight,
               PrimitiveModel& model,
               double& damping) {
  const System system = system_at(samples, weight, model);
  for (; damping < 1e12; damping *= 10) {
    Eigen::MatrixXd damped = system.information;
    damped.diagonal() *= 1 + damping;
    const Eigen::VectorXd step = damped.ldlt().solve(system.right);
    if (!step.allFinite()) continue;
    model.move(step);
    const double cost = system_at(samples, weight, model).cost;
    if (cost <= system.cost) {
      damping = std::max(1e-12, damping / 10);
      return system.cost > 0 ? 1 - cost / system.cost : 0;
    }
    model.undo();
  }
  damping = 1e-3;
  return -1;
}

void require_decided(const Eigen::MatrixXd& information) {
  // Scaled to a unit diagonal, so that metres and radians compare.
  const Eigen::VectorXd scale = information.diagonal().cwiseSqrt().cwiseInverse();
  require(scale.allFinite(), "the points leave a parameter of the shape undecided");
  const Eigen::MatrixXd scaled = scale.asDiagonal() * information * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scaled);
  require(solver.eigenvalues()(0) > 1e-13,
          "the points leave the shape's size or place undecided; they must cover more of it");
}

/// Covariance of the parameters where the points' variances are those.
Eigen::MatrixXd covariance_of(const std::vector<Sample>& samples,
                              const std::vector<double>& weight,
                              const std::vector<double>& variance,
                              const PrimitiveModel& model) {
  const int n = model.parameters();
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(n, n);
  Eigen::MatrixXd noise = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd gradient(n);
  Eigen::Vector3d normal;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    model.distance(samples[i].x, normal, gradient);
    information += weight[i] * gradient * gradient.transpose();
    noise += weight[i] * weight[i] * variance[i] * gradient * gradient.transpose();
  }
  require_decided(information);
  const Eigen::MatrixXd inverse = information.ldlt().solve(Eigen::MatrixXd::Identity(n, n));
  return inverse * noise * inverse;
}

void describe(const std::vector<Sample>& samples,
              const std::vector<double>& weight,
              const PrimitiveModel& model,
              PrimitiveQuality& quality) {
  Distances distances = distances_from(samples, model);
  const double freedom = static_cast<double>(quality.degrees_of_freedom);
  const double squares = std::accumulate(distances.squares.begin(), distances.squares.end(), 0.0);
  quality.rms = freedom > 0 ? std::sqrt(squares / freedom) : 0;
  quality.peak_to_valley = distances.most - distances.least;
  std::vector<double>& variance = distances.variances;
  if (samples.front().sigma > 0) {
    for (std::size_t i = 0; i < variance.size(); ++i) {
      quality.chi_squared += distances.squares[i] / variance[i];
    }
    const double added =
        unexplained_variance(distances.squares, variance, quality.degrees_of_freedom);
    quality.unexplained = std::sqrt(added);
    for (double& v : variance) v += added;
  } else {
    // As many points as parameters scatter about nothing: how sure they are is not known.
    const double scatter =
        freedom > 0 ? quality.rms * quality.rms : std::numeric_limits<double>::quiet_NaN();
    std::fill(variance.begin(), variance.end(), scatter);
  }
  quality.covariance = covariance_of(samples, weight, variance, model);
}

/// Moves the model to where the weighted squares are least.
void settle(const std::vector<Sample>& samples,
            const std::vector<double>& weight,
            const PrimitiveFitOptions& options,
            PrimitiveModel& model,
            PrimitiveQuality& quality) {
  double damping = 1e-3;
  int settled = 0;
  for (int i = 0; i < options.max_iterations && settled < 2; ++i) {
    const double gain = improve(samples, weight, model, damping);
    settled = gain < 1e-12 ? settled + 1 : 0;
    ++quality.iterations;
  }
  require(settled == 2,
          "the fit reached no end within ",
          options.max_iterations,
          " rounds; the points may not lie on such a shape");
}

}  // namespace

PrimitiveQuality fit_primitive(const PointCloud& cloud,
                               const std::vector<std::size_t>& indices,
                               PrimitiveModel& model,
                               const PrimitiveFitOptions& options) {
  const std::vector<Sample> samples = samples_of(cloud, indices);
  const auto least = static_cast<std::size_t>(model.parameters());
  require(samples.size() >= least,
          "the shape needs at least ",
          least,
          " points that are finite, got ",
          samples.size());
  PrimitiveQuality quality;
  quality.points = samples.size();
  quality.degrees_of_freedom = samples.size() - least;
  std::vector<double> weight(samples.size(), 1.0);
  settle(samples, weight, options, model, quality);
  const bool weigh = options.weigh_by_sigma && samples.front().sigma > 0;
  for (int round = 0; weigh && round < kWeightingRounds; ++round) {
    weight = weights_at(samples, model);
    settle(samples, weight, options, model, quality);
  }
  describe(samples, weight, model, quality);
  return quality;
}

}  // namespace facula
