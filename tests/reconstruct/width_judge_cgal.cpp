// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/tests/reconstruct/width_judge_cgal.hpp>

#include <cmath>

#include <CGAL/Gmpz.h>
#include <CGAL/Homogeneous.h>
#include <CGAL/Width_3.h>
#include <CGAL/Width_default_traits_3.h>

namespace facula {

double judged_width(const std::vector<Eigen::Vector3d>& points, double unit) {
  using Kernel = CGAL::Homogeneous<CGAL::Gmpz>;
  std::vector<Kernel::Point_3> whole;
  whole.reserve(points.size());
  for (const Eigen::Vector3d& p : points) {
    const auto number = [unit](double x) { return CGAL::Gmpz(static_cast<long>(x / unit)); };
    whole.emplace_back(number(p.x()), number(p.y()), number(p.z()), CGAL::Gmpz(1));
  }
  CGAL::Width_3<CGAL::Width_default_traits_3<Kernel>> judge(whole.begin(), whole.end());
  CGAL::Gmpz numerator;
  CGAL::Gmpz denominator;
  judge.get_squared_width(numerator, denominator);
  return unit * std::sqrt(CGAL::to_double(numerator) / CGAL::to_double(denominator));
}

}  // namespace facula
