// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/reconstruct/register/robust_weight.hpp>

#include <cmath>

namespace facula {
namespace {

RobustWeight huber(double u) {
  constexpr double k = 1.345;
  const double size = std::abs(u);
  return size <= k ? RobustWeight{1, 1} : RobustWeight{k / size, 0};
}

RobustWeight cauchy(double u) {
  constexpr double k2 = 2.385 * 2.385;
  const double d = k2 + u * u;
  return {k2 / d, k2 * (k2 - u * u) / (d * d)};
}

RobustWeight geman_mcclure(double u) {
  constexpr double k2 = 3.0 * 3.0;
  const double d = k2 + u * u;
  return {k2 * k2 / (d * d), k2 * k2 * (k2 - 3 * u * u) / (d * d * d)};
}

RobustWeight tukey(double u) {
  constexpr double k2 = 4.685 * 4.685;
  const double t = 1 - u * u / k2;
  return t <= 0 ? RobustWeight{0, 0} : RobustWeight{t * t, t * (t - 4 * u * u / k2)};
}

}  // namespace

RobustWeight robust_weight(RobustKernel kernel, double u) {
  switch (kernel) {
    case RobustKernel::kHuber:
      return huber(u);
    case RobustKernel::kCauchy:
      return cauchy(u);
    case RobustKernel::kGemanMcClure:
      return geman_mcclure(u);
    case RobustKernel::kTukey:
      return tukey(u);
    case RobustKernel::kNone:
      break;
  }
  return {};
}

}  // namespace facula
