// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/calibrate/board_pattern.hpp>
#include <facula/acquire/calibrate/render_board.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/acquire/core/random.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace facula {
namespace {

/// Light of the room (all colours alike) and of the lasers (red).
struct Light {
  std::vector<float> room;
  std::vector<float> red;
};

/// The meeting of a pixel's ray with the board.
struct Meeting {
  Eigen::Vector3d x_in_camera;
  Eigen::Vector2d place;  ///< on the board [m]
};

class Renderer {
 public:
  Renderer(const Board& board,
           const Camera& camera,
           const RigidTransform& camera_from_board,
           const std::vector<LaserPlane>& lasers,
           const RenderBoardOptions& options)
      : pattern_(board),
        camera_(camera),
        board_from_camera_(camera_from_board.inverse()),
        lasers_(lasers),
        options_(options) {}

  std::optional<Meeting> meet(const Eigen::Vector2d& pixel) const {
    const auto ray = camera_.undistort(pixel);
    if (!ray) return std::nullopt;
    const Eigen::Vector3d direction(ray->x(), ray->y(), 1);
    const double approach = (board_from_camera_.rotation * direction).z();
    if (std::abs(approach) < 1e-9) return std::nullopt;
    const double t = -board_from_camera_.translation.z() / approach;
    if (!(t > 0)) return std::nullopt;
    const Eigen::Vector3d x = t * direction;
    return Meeting{x, (board_from_camera_ * x).head<2>()};
  }

  void pixel(int row, int col, float& room, float& red) const {
    const int n = options_.samples;
    double room_sum = 0;
    double red_sum = 0;
    for (int i = 0; i < n * n; ++i) {
      const int across = i % n;
      const int down = i / n;
      const Eigen::Vector2d at(col - 0.5 + (across + 0.5) / n, row - 0.5 + (down + 0.5) / n);
      const auto here = meet(at);
      if (!here || !pattern_.covers(here->place)) {
        room_sum += options_.surroundings;
        continue;
      }
      const double footprint = here->x_in_camera.z() / std::sqrt(camera_.fx * camera_.fy) / n;
      const double white = pattern_.white(here->place, footprint);
      room_sum += options_.black + white * (options_.white - options_.black);
      red_sum += laser_light(here->x_in_camera) *
                 (options_.laser_on_black + white * (1 - options_.laser_on_black));
    }
    room = static_cast<float>(room_sum / (n * n));
    red = static_cast<float>(red_sum / (n * n));
  }

 private:
  double laser_light(const Eigen::Vector3d& x_in_camera) const {
    double sum = 0;
    for (const LaserPlane& laser : lasers_) {
      const double from = laser.sheet_distance(x_in_camera) / options_.laser_width;
      sum += options_.laser_level * std::exp(-0.5 * from * from);
    }
    return sum;
  }

  BoardPattern pattern_;
  const Camera& camera_;
  RigidTransform board_from_camera_;
  const std::vector<LaserPlane>& lasers_;
  const RenderBoardOptions& options_;
};

/// Gaussian blur along rows, then along columns; borders repeat.
void blur(std::vector<float>& values, int rows, int cols, double sigma) {
  if (!(sigma > 0)) return;
  const int reach = static_cast<int>(std::ceil(4 * sigma));
  std::vector<float> kernel;
  float total = 0;
  for (int k = -reach; k <= reach; ++k) {
    kernel.push_back(static_cast<float>(std::exp(-0.5 * k * k / (sigma * sigma))));
    total += kernel.back();
  }
  for (float& weight : kernel) weight /= total;
  const auto pass = [&](bool along_rows) {
    const std::vector<float> from = values;
    for (int r = 0; r < rows; ++r) {
      for (int c = 0; c < cols; ++c) {
        float sum = 0;
        for (int k = -reach; k <= reach; ++k) {
          const int rr = along_rows ? r : std::clamp(r + k, 0, rows - 1);
          const int cc = along_rows ? std::clamp(c + k, 0, cols - 1) : c;
          sum += kernel[static_cast<std::size_t>(k + reach)] *
                 from[static_cast<std::size_t>(rr) * static_cast<std::size_t>(cols) +
                      static_cast<std::size_t>(cc)];
        }
        values[static_cast<std::size_t>(r) * static_cast<std::size_t>(cols) +
               static_cast<std::size_t>(c)] = sum;
      }
    }
  };
  pass(true);
  pass(false);
}

std::uint8_t level(double value) {
  return static_cast<std::uint8_t>(std::clamp(std::lround(value), 0L, 255L));
}

Image8 expose(const Light& light, const Camera& camera, const RenderBoardOptions& options) {
  Image8 image(camera.height, camera.width, 3);
  Random random(options.seed);
  for (std::size_t i = 0; i < light.room.size(); ++i) {
    // A red laser leaks into the other colours of a Bayer sensor by a few per cent.
    const std::array<double, 3> colour = {light.room[i] + 0.04 * light.red[i],
                                          light.room[i] + 0.08 * light.red[i],
                                          static_cast<double>(light.room[i] + light.red[i])};
    for (std::size_t k = 0; k < 3; ++k) {
      image.pixels[3 * i + k] = level(colour[k] + options.noise * random.normal());
    }
  }
  return image;
}

}  // namespace

void RenderBoardOptions::check() const {
  require(samples >= 1 && samples <= 16, "samples: expected 1 to 16, got ", samples);
  require(blur >= 0 && blur < 50, "blur_px: expected 0 to 50, got ", blur);
  require(noise >= 0 && noise < 100, "noise_dn: expected 0 to 100, got ", noise);
  require(laser_width > 0 && std::isfinite(laser_width),
          "laser_width_mm: expected above 0, got ",
          1000 * laser_width);
}

Image8 render_board(const Board& board,
                    const Camera& camera,
                    const RigidTransform& camera_from_board,
                    const std::vector<LaserPlane>& lasers,
                    const RenderBoardOptions& options) {
  board.check();
  camera.check();
  options.check();
  for (const Eigen::Vector3d& corner : board.outline(1)) {
    require((camera_from_board * corner).z() > 1e-3,
            "the board lies behind the camera; move it along z");
  }
  const Renderer renderer(board, camera, camera_from_board, lasers, options);
  const std::size_t pixels =
      static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  Light light{std::vector<float>(pixels), std::vector<float>(pixels)};
  const auto cols = static_cast<std::size_t>(camera.width);
  const auto render_rows = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin * cols; i < end * cols; ++i) {
      renderer.pixel(
          static_cast<int>(i / cols), static_cast<int>(i % cols), light.room[i], light.red[i]);
    }
  };
  parallel_for(static_cast<std::size_t>(camera.height),
               render_rows,
               {.num_threads = options.num_threads, .chunk = 16});
  blur(light.room, camera.height, camera.width, options.blur);
  blur(light.red, camera.height, camera.width, options.blur);
  return expose(light, camera, options);
}

}  // namespace facula
