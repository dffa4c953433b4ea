// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/reconstruct/register/robust_weight.hpp>

#include <cmath>

namespace facula {
namespace {

RobustWeight huber(double u) {
  constexpr double kBound = 1.345;
  const double size = std::abs(u);
  return size <= kBound ? RobustWeight{1, 1} : RobustWeight{kBound / size, 0};
}

RobustWeight cauchy(double u) {
  constexpr double kSquare = 2.385 * 2.385;
  const double d = kSquare + u * u;
  return {kSquare / d, kSquare * (kSquare - u * u) / (d * d)};
}

RobustWeight geman_mcclure(double u) {
  constexpr double kSquare = 3.0 * 3.0;
  const double d = kSquare + u * u;
  return {kSquare * kSquare / (d * d), kSquare * kSquare * (kSquare - 3 * u * u) / (d * d * d)};
}

RobustWeight tukey(double u) {
  constexpr double kSquare = 4.685 * 4.685;
  const double t = 1 - u * u / kSquare;
  return t <= 0 ? RobustWeight{0, 0} : RobustWeight{t * t, t * (t - 4 * u * u / kSquare)};
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
