// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/stripe/line_bias.hpp>
#include <facula/acquire/stripe/peak_detector.hpp>
#include <facula/acquire/stripe/position_noise.hpp>
#include <facula/acquire/stripe/three_point.hpp>

#include <algorithm>
#include <cmath>

namespace facula {
namespace {

/// The brightest pixel and its neighbours, over the surroundings.
struct Triple {
  double a = 0;  ///< [DN]
  double b = 0;  ///< [DN]
  double c = 0;  ///< [DN]
};

/// Where the top lies beside the middle pixel, and how the three values move it.
struct Vertex {
  double offset = 0;  ///< [px]
  Triple weight;      ///< [px/DN]
};

/// Offset and derivatives of the parabola through three values.
std::optional<Vertex> vertex(const Triple& v) {
  const double bend = v.a - 2 * v.b + v.c;
  if (!(bend < 0)) return std::nullopt;
  const double square = bend * bend;
  return Vertex{(v.a - v.c) / (2 * bend),
                {(v.c - v.b) / square, (v.a - v.c) / square, (v.b - v.a) / square}};
}

std::optional<Vertex> parabola_vertex(const Triple& v) {
  return vertex(v);
}

std::optional<Vertex> gauss_vertex(const Triple& v) {
  if (!(std::min({v.a, v.b, v.c}) > 0)) return std::nullopt;
  auto top = vertex({std::log(v.a), std::log(v.b), std::log(v.c)});
  if (top) {
    top->weight.a /= v.a;
    top->weight.b /= v.b;
    top->weight.c /= v.c;
  }
  return top;
}

double parabola_bias(double width, double place) {
  const double u = 1 / (width * width);
  const double e = std::exp(-0.5 * u);
  return e * std::sinh(place * u) / (2 * (1 - e * std::cosh(place * u))) - place;
}

double gauss_bias(double /*width*/, double /*place*/) {
  return 0;
}

class ThreePoint : public PeakDetector {
 public:
  using VertexOf = std::optional<Vertex> (*)(const Triple&);
  using BiasOf = double (*)(double width, double place);

  ThreePoint(double sigma, VertexOf vertex_of, BiasOf bias_of)
      : PeakDetector(sigma), vertex_of_(vertex_of), bias_of_(bias_of) {}

 private:
  bool place(const Peak& peak, StripeCandidate& found) const override {
    const SignalRow& row = peak.row;
    const PeakShape& shape = peak.shape;
    if (shape.last - shape.first > 1) return false;
    const int c = shape.first;
    if (!row.holds(c - 1) || !row.holds(c + 1)) return false;
    const double level = shape.background;
    const Triple values = {row.at(c - 1) - level, row.at(c) - level, row.at(c + 1) - level};
    const auto top = vertex_of_(values);
    if (!top) return false;
    found.position = static_cast<float>(c + top->offset);
    PositionNoise noise;
    noise.add(top->weight.a, values.a);
    noise.add(top->weight.b, values.b);
    noise.add(top->weight.c, values.c);
    noise.share_background(shape.background_count);
    noise.store(found);
    const double width = std::max(0.5, static_cast<double>(found.width));
    found.sigma_step =
        static_cast<float>(rms_bias([&](double place) { return bias_of_(width, place); }));
    return true;
  }

  VertexOf vertex_of_;
  BiasOf bias_of_;
};

}  // namespace

std::unique_ptr<RowDetector> make_parabola(double sigma) {
  return std::make_unique<ThreePoint>(sigma, parabola_vertex, parabola_bias);
}

std::unique_ptr<RowDetector> make_gauss(double sigma) {
  return std::make_unique<ThreePoint>(sigma, gauss_vertex, gauss_bias);
}

}  // namespace facula
