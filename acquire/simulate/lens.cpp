// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/simulate/lens.hpp>

#include <algorithm>
#include <cmath>

namespace facula {
namespace {

// One line of pixels, `step` elements apart.
void blur_line(double* first, int count, std::ptrdiff_t step, const std::vector<double>& weights) {
  const int reach = static_cast<int>(weights.size()) - 1;
  std::vector<double> line(static_cast<std::size_t>(count + 2 * reach));
  for (int i = 0; i < static_cast<int>(line.size()); ++i) {
    line[static_cast<std::size_t>(i)] = first[std::clamp(i - reach, 0, count - 1) * step];
  }
  for (int i = 0; i < count; ++i) {
    const double* middle = line.data() + i + reach;
    double sum = weights[0] * middle[0];
    for (int k = 1; k <= reach; ++k) {
      sum += weights[static_cast<std::size_t>(k)] * (middle[-k] + middle[k]);
    }
    first[i * step] = sum;
  }
}

void blur(Image<double>& image, double sigma) {
  if (sigma == 0 || image.empty()) return;
  const std::vector<double> weights = blur_weights(sigma);
  for (int r = 0; r < image.rows; ++r) {
    for (int k = 0; k < image.channels; ++k) {
      blur_line(image.row(r) + k, image.cols, image.channels, weights);
    }
  }
  for (int c = 0; c < image.cols * image.channels; ++c) {
    blur_line(image.row(0) + c, image.rows, image.stride(), weights);
  }
}

}  // namespace

std::vector<double> blur_weights(double sigma) {
  const double t = sigma * sigma;
  const int reach = static_cast<int>(std::ceil(6 * sigma)) + 2;
  // Miller's downward recurrence I_(n-1) = I_(n+1) + 2 n / t I_n, then scaled to the sum 1.
  std::vector<double> weights(static_cast<std::size_t>(reach) + 1, 0.0);
  if (t < 1e-12) return {1.0};
  double above = 0;
  double here = 1e-300;
  for (int n = 4 * reach + 20; n > 0; --n) {
    const double below = above + 2 * n / t * here;
    above = here;
    here = below;
    if (here > 1e250) {
      above *= 1e-250;
      here *= 1e-250;
      for (double& weight : weights) weight *= 1e-250;
    }
    if (n - 1 <= reach) weights[static_cast<std::size_t>(n - 1)] = here;
  }
  double sum = weights[0];
  for (std::size_t n = 1; n < weights.size(); ++n) sum += 2 * weights[n];
  for (double& weight : weights) weight /= sum;
  return weights;
}

void spread_light(Image<double>& image, const Lens& lens) {
  blur(image, lens.blur);
  if (lens.glare_share == 0) return;
  Image<double> glare = image;
  blur(glare, lens.glare_blur);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    image.pixels[i] += lens.glare_share * (glare.pixels[i] - image.pixels[i]);
  }
}

void vignette(Image<double>& image, const RayTable& rays, double vignetting) {
  if (vignetting == 0) return;
  for (int r = 0; r < image.rows; ++r) {
    for (int c = 0; c < image.cols; ++c) {
      const double tan2 = rays.centre(r, c).squaredNorm();
      const double share = std::pow(1 + tan2, -0.5 * vignetting);  // cos^v
      for (int k = 0; k < image.channels; ++k) image.row(r)[c * image.channels + k] *= share;
    }
  }
}

}  // namespace facula
