// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/random.hpp>
#include <facula/tests/reconstruct/width_clouds.hpp>

#include <array>
#include <cmath>
#include <cstdint>

#include <Eigen/Geometry>

namespace facula {
namespace {

using Points = std::vector<Eigen::Vector3d>;

Eigen::Vector3d even(Random& random) {
  return {random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5};
}

Eigen::Vector3d normal(Random& random) {
  return {random.normal(), random.normal(), random.normal()};
}

Eigen::Vector3d lattice(Random& random, std::uint64_t size) {
  return {static_cast<double>(random.below(size)),
          static_cast<double>(random.below(size)),
          static_cast<double>(random.below(size))};
}

/// A point of the prism's two end faces or, one in three, between them.
Eigen::Vector3d on_prism(Random& random, std::uint64_t sides) {
  const double angle =
      2 * M_PI * static_cast<double>(random.below(sides)) / static_cast<double>(sides);
  const double height =
      random.below(3) == 0 ? random.uniform() : static_cast<double>(random.below(2));
  return {std::cos(angle), std::sin(angle), height};
}

struct Kind {
  const char* name;
  Eigen::Vector3d (*point)(Random&);
  bool turned;  // by any angle
  bool whole;   // coordinates are small whole numbers
  bool flat;
};

constexpr std::array<Kind, 12> kKinds{{
    {"even", even, true, false, false},
    {"normal", normal, true, false, false},
    {"sphere", [](Random& r) { return normal(r).normalized().eval(); }, true, false, false},
    {"box",
     [](Random& r) -> Eigen::Vector3d {
       return lattice(r, 2).cwiseProduct(Eigen::Vector3d(3, 5, 7));
     },
     false,
     true,
     false},
    {"box surface",
     [](Random& r) -> Eigen::Vector3d {
       Eigen::Vector3d p = lattice(r, 1000);
       p[static_cast<int>(r.below(3))] = r.below(2) == 0 ? 0 : 999;
       return p;
     },
     false,
     true,
     false},
    {"prism", [](Random& r) { return on_prism(r, 7); }, true, false, false},
    {"lattice", [](Random& r) { return lattice(r, 5); }, false, true, false},
    {"plate",
     [](Random& r) -> Eigen::Vector3d {
       return {r.uniform(), r.uniform(), 1e-4 * r.normal()};
     },
     true,
     false,
     false},
    {"rounded plane",
     [](Random& r) -> Eigen::Vector3d {
       return {r.uniform(), r.uniform(), 0};
     },
     true,
     false,
     false},
    {"needle",
     [](Random& r) -> Eigen::Vector3d {
       return {r.uniform(), 1e-3 * r.normal(), 1e-6 * r.normal()};
     },
     true,
     false,
     false},
    {"plane",
     [](Random& r) -> Eigen::Vector3d {
       const Eigen::Vector3d p = lattice(r, 100);
       return {p.x(), p.y(), 2 * p.x() - 3 * p.y()};
     },
     false,
     true,
     true},
    {"line",
     [](Random& r) -> Eigen::Vector3d {
       return static_cast<double>(r.below(100)) * Eigen::Vector3d(1, -2, 3);
     },
     false,
     true,
     true},
}};

std::size_t size_of_cloud(Random& random) {
  constexpr std::array<std::size_t, 6> kSizes{4, 5, 8, 30, 120, 400};
  return kSizes[random.below(kSizes.size())];
}

}  // namespace

WidthCloud width_cloud(unsigned seed) {
  Random random(seed, 4711);
  const Kind& kind = kKinds[seed % kKinds.size()];
  WidthCloud cloud{kind.name, {}, 1, kind.flat};
  const Eigen::Quaterniond turn =
      Eigen::Quaterniond(random.normal(), random.normal(), random.normal(), random.normal())
          .normalized();
  // A third has the 24 digits of a float, the rest more.
  const double grain = std::ldexp(1.0, random.below(3) == 0 ? -23 : -44);
  const Eigen::Vector3d offset =
      random.below(2) == 0 ? Eigen::Vector3d::Zero() : Eigen::Vector3d(100 * even(random));
  const std::size_t count = size_of_cloud(random);
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::Vector3d p = kind.point(random);
    if (kind.turned) p = turn * p;
    p += offset;
    const double step = kind.whole ? 1.0 : grain;
    for (double& x : p) x = std::round(x / step) * step;
    cloud.points.push_back(p);
    if (random.below(8) == 0) cloud.points.push_back(cloud.points[random.below(i + 1)]);
  }
  const double scale = std::ldexp(1.0, static_cast<int>(random.below(121)) - 60);
  for (Eigen::Vector3d& p : cloud.points) p *= scale;
  cloud.unit = scale * (kind.whole ? 1.0 : grain);
  return cloud;
}

}  // namespace facula
