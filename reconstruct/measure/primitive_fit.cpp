// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/known_sigma.hpp>
#include <facula/reconstruct/measure/primitive_fit.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace facula {
namespace {

constexpr double kLeastCosine = 0.087;  // as plane fits: no ray is more grazing than 85 degrees

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

std::vector<double> weights_at(const std::vector<Sample>& samples,
                               const PrimitiveModel& model,
                               bool weigh) {
  std::vector<double> weight(samples.size(), 1.0);
  Eigen::VectorXd gradient(model.parameters());
  Eigen::Vector3d normal;
  for (std::size_t i = 0; i < samples.size() && weigh; ++i) {
    model.distance(samples[i].x, normal, gradient);
    weight[i] = 1 / std::pow(samples[i].sigma_along(normal), 2);
  }
  return weight;
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

void describe(const std::vector<Sample>& samples,
              const std::vector<double>& weight,
              const PrimitiveModel& model,
              PrimitiveQuality& quality) {
  const int n = model.parameters();
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(n, n);
  Eigen::MatrixXd noise = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd gradient(n);
  Eigen::Vector3d normal;
  const bool has_sigma = samples.front().sigma > 0;
  double squares = 0;
  double least = std::numeric_limits<double>::infinity();
  double most = -least;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double d = model.distance(samples[i].x, normal, gradient);
    const double sigma = has_sigma ? samples[i].sigma_along(normal) : 1;
    squares += d * d;
    least = std::min(least, d);
    most = std::max(most, d);
    if (has_sigma) quality.chi_squared += std::pow(d / sigma, 2);
    information += weight[i] * gradient * gradient.transpose();
    noise += std::pow(weight[i] * sigma, 2) * gradient * gradient.transpose();
  }
  require_decided(information);
  const double freedom = static_cast<double>(quality.degrees_of_freedom);
  quality.rms = freedom > 0 ? std::sqrt(squares / freedom) : 0;
  quality.peak_to_valley = most - least;
  const double misfit = freedom > 0 ? std::max(1.0, quality.chi_squared / freedom) : 1;
  const Eigen::MatrixXd inverse = information.ldlt().solve(Eigen::MatrixXd::Identity(n, n));
  // As many points as parameters scatter about nothing: how sure they are is not known.
  const double scatter =
      freedom > 0 ? quality.rms * quality.rms : std::numeric_limits<double>::quiet_NaN();
  const double factor = has_sigma ? misfit : scatter;
  quality.covariance = factor * inverse * noise * inverse;
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
  const bool weigh = options.weigh_by_sigma && samples.front().sigma > 0;
  PrimitiveQuality quality;
  quality.points = samples.size();
  quality.degrees_of_freedom = samples.size() - least;
  std::vector<double> weight = weights_at(samples, model, weigh);
  double damping = 1e-3;
  int settled = 0;
  for (int i = 0; i < options.max_iterations && settled < 2; ++i) {
    const double gain = improve(samples, weight, model, damping);
    settled = gain < 1e-12 ? settled + 1 : 0;
    // The normals settle within a few rounds; weights that went on changing would never end.
    if (i < 4) weight = weights_at(samples, model, weigh);
    quality.iterations = i + 1;
  }
  require(settled == 2,
          "the fit reached no end within ",
          options.max_iterations,
          " rounds; the points may not lie on such a shape");
  describe(samples, weight, model, quality);
  return quality;
}

}  // namespace facula
