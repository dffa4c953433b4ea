// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/rig/rig_file.hpp>
#include <facula/acquire/simulate/frame_renderer.hpp>
#include <facula/tests/acquire/simulate/small_head.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/real_data.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace facula {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

struct Line {
  double sum = 0;       // [DN px]
  double position = 0;  // centre of gravity [px]
  double variance = 0;  // [px^2]
};

// Moments of the light in a row: exact where nothing but the line shines.
Line moments(const Image<double>& image, int r) {
  Line line;
  for (int c = 0; c < image.cols; ++c) line.sum += image.row(r)[c];
  for (int c = 0; c < image.cols; ++c) line.position += c * image.row(r)[c] / line.sum;
  for (int c = 0; c < image.cols; ++c) {
    line.variance += std::pow(c - line.position, 2) * image.row(r)[c] / line.sum;
  }
  return line;
}

Image<double> clean_image(const std::vector<SceneObject>& objects,
                          const Rig& rig,
                          const SimulateOptions& options) {
  const Scene scene = scene_with(objects);
  return FrameRenderer(scene, rig, options).expected_signal({}, true);
}

double worst_line_error(const Rig& rig, const SimulateOptions& options, double depth) {
  const Image<double> image = clean_image({wall_at(depth)}, rig, options);
  const PolarScan truth = true_scan(scene_with({wall_at(depth)}), rig, {}, {0.0}, options);
  double worst = 0;
  for (int r = 0; r < image.rows; ++r) {
    const std::size_t cell = truth.index(r, 0);
    EXPECT_EQ(truth.valid[cell], 1) << "row " << r;
    const double expected = rig.camera.project(truth.point[cell].cast<double>()).x();
    worst = std::max(worst, std::abs(moments(image, r).position - expected));
  }
  return worst;
}

TEST(SimulateFrame, PutsTheLineWhereTheTruthProjects) {
  Rig rig = small_head();
  EXPECT_LT(worst_line_error(rig, quiet_options(rig), 1.7), 0.02);
  EXPECT_LT(worst_line_error(rig, quiet_options(rig), 2.3), 0.02);
  rig.camera.k1 = -0.2;
  rig.camera.p1 = 0.002;
  EXPECT_LT(worst_line_error(rig, quiet_options(rig), 2.0), 0.02);
}

TEST(SimulateFrame, QuadratureKeepsALineOfOnePixelWithinFiveThousandths) {
  const Rig rig = small_head();
  SimulateOptions options = quiet_options(rig);
  options.line_divergence = 0;
  for (int i = 0; i < 10; ++i) {
    const double depth = 1.9 + 0.013 * i;  // the line takes other sub-pixel places
    options.line_half_width = 1.0 / 600 * depth;
    EXPECT_LT(worst_line_error(rig, options, depth), 0.005) << depth;
  }
}

// Width: a sheet of half width w that meets the wall with n_x = sin of the angle between them is
// w / n_x wide there, f / z times that in the image, and the pixel adds the variance 1/12.
// Height: the sum over a row is the peak times sqrt(2 pi) times the width before the pixel.
TEST(SimulateFrame, LineHasTheWidthAndPowerOfTheFormula) {
  const Rig rig = small_head();
  const SimulateOptions options = quiet_options(rig);
  for (const double depth : {1.6, 2.0, 2.4}) {
    const Image<double> image = clean_image({wall_at(depth)}, rig, options);
    const double nx = rig.lasers[0].normal.x();
    const double x = (0.25 - rig.lasers[0].normal.z() * depth) / nx;
    const double y = (60 - rig.camera.cy) / 600 * depth;
    const Vector3d to_laser = Vector3d(0.25 / nx, 0, 0) - Vector3d(x, y, depth);
    const double r = to_laser.norm();
    const double w = options.line_half_width + options.line_divergence * r;
    const double w1 = options.line_half_width + options.line_divergence;
    const double sigma = 600 / depth * w / nx;
    const double peak = 0.8 * options.laser_peak * (depth / r) * w1 / w;
    const Line line = moments(image, 60);
    EXPECT_NEAR(line.variance, sigma * sigma + 1.0 / 12, 0.005 * sigma * sigma);
    EXPECT_NEAR(line.sum, peak * std::sqrt(2 * M_PI) * sigma, 0.002 * line.sum);
    EXPECT_NEAR(line.position, 119.5 + 600 * x / depth, 0.005);
  }
}

TEST(SimulateFrame, LightFallsOffWithThePowerAskedFor) {
  const Rig rig = small_head();
  SimulateOptions options = quiet_options(rig);
  const double r = std::hypot(0.25 / rig.lasers[0].normal.x(), 2.0);
  const double even = moments(clean_image({wall_at(2)}, rig, options), 60).sum;
  for (const double power : {0.5, 1.0, 2.0}) {
    options.exposure_falloff = power;
    const double sum = moments(clean_image({wall_at(2)}, rig, options), 60).sum;
    EXPECT_NEAR(sum, even * std::pow(r, -power), 0.002 * even) << power;
  }
}

TEST(SimulateFrame, NoiseIsReadNoisePlusShotNoisePlusRounding) {
  const Rig rig = small_head();
  SimulateOptions options = quiet_options(rig);
  options.ambient = 100.37;
  options.black_level = 7.5;
  options.read_noise = 2;
  options.shot_noise = 0.09;
  const Scene scene = scene_with({wall_at(2)});
  const FrameRenderer renderer(scene, rig, options);
  double sum = 0;
  double squares = 0;
  double count = 0;
  for (std::uint64_t frame = 0; frame < 10; ++frame) {
    for (const std::uint8_t pixel : renderer.render({}, false, frame).pixels) {
      sum += pixel;
      squares += pixel * static_cast<double>(pixel);
      ++count;
    }
  }
  const double mean = sum / count;
  const double variance = squares / count - mean * mean;
  const double signal = 0.8 * 100.37;
  const double expected = 4 + 0.09 * signal + 1.0 / 12;
  EXPECT_NEAR(mean, signal + 7.5, 4 * std::sqrt(expected / count));
  EXPECT_NEAR(variance, expected, 4 * expected * std::sqrt(2 / count));
}

TEST(SimulateFrame, NoiseDiffersBetweenFramesAndSeedsOnly) {
  const Rig rig = small_head();
  SimulateOptions options = options_for(rig);
  const Scene scene = scene_with({wall_at(2)});
  const Image8 first = simulate_frame(scene, rig, {}, true, 3, options);
  EXPECT_EQ(simulate_frame(scene, rig, {}, true, 3, options).pixels, first.pixels);
  EXPECT_NE(simulate_frame(scene, rig, {}, true, 4, options).pixels, first.pixels);
  options.seed = 2;
  EXPECT_NE(simulate_frame(scene, rig, {}, true, 3, options).pixels, first.pixels);
}

TEST(SimulateFrame, ClipsAtTwoHundredAndFiftyFive) {
  const Rig rig = small_head();
  SimulateOptions options = quiet_options(rig);
  options.laser_peak = 5000;
  const Image8 image = simulate_frame(scene_with({wall_at(2)}), rig, {}, true, 0, options);
  const std::uint8_t* row = image.row(60);
  EXPECT_EQ(*std::max_element(row, row + image.cols), 255);
  EXPECT_EQ(row[0], 0);
}

// A small box stands between the laser and the lower half of the line, beside the camera's view of
// it: those rows stay dark; the box itself is not in the way of the camera.
TEST(SimulateFrame, ThingBeforeTheLaserCastsAShadow) {
  const Rig rig = small_head();
  const SimulateOptions options = quiet_options(rig);
  SceneObject wall = wall_at(2);
  // Half way between the laser at (0.252, 0, 0) and the line at (0, y, 2), below the axis. From
  // the camera it lies at x / z = 0.126: column 195.
  SceneObject blocker = box_at({0.126, 0.55, 1.0}, {0.04, 1.0, 0.02});  // y from 0.05 on
  blocker.albedo = 0;
  const Image<double> image = clean_image({wall, blocker}, rig, options);
  const Image<double> free = clean_image({wall}, rig, options);
  const PolarScan truth = true_scan(scene_with({wall, blocker}), rig, {}, {0.0}, options);
  // The blocker's upper edge at y = 0.05, z = 0.99 throws its shadow to y = 0.101 on the wall.
  const double edge_row = rig.camera.cy + 600 * (0.05 * 2 / 0.99) / 2;
  for (int r = 0; r < image.rows; ++r) {
    const bool lit = r < edge_row;
    if (std::abs(r - edge_row) < 1) continue;
    EXPECT_NEAR(moments(image, r).sum, lit ? moments(free, r).sum : 0.0, 1e-9) << r;
    // Below, the sheet's middle lies on the black blocker: bright enough for nobody.
    EXPECT_EQ(truth.valid[truth.index(r, 0)], lit ? 1 : 0) << r;
  }
}

TEST(SimulateFrame, ThingBeforeTheCameraHidesTheLine) {
  const Rig rig = small_head();
  const SimulateOptions options = quiet_options(rig);
  // On the camera's way to the line (x = 0), left of the sheet at that depth; upper half.
  SceneObject cover = box_at({0, -0.5, 1.0}, {0.06, 1.0, 0.02});
  const Image<double> image = clean_image({wall_at(2), cover}, rig, options);
  const PolarScan truth = true_scan(scene_with({wall_at(2), cover}), rig, {}, {0.0}, options);
  for (const int r : {5, 30, 57}) {
    EXPECT_NEAR(image.row(r)[119] + image.row(r)[120], 0, 1e-9) << r;
    EXPECT_EQ(truth.valid[truth.index(r, 0)], 0) << r;
  }
  for (const int r : {62, 80, 115}) {
    EXPECT_GT(image.row(r)[119], 50) << r;
    EXPECT_EQ(truth.valid[truth.index(r, 0)], 1) << r;
  }
}

// The upper edge of a near board runs through a row: the pixels there are part box and part wall,
// in the share that the edge cuts off (in quarters, as there are four rows of sub-pixels).
TEST(SimulateFrame, DepthEdgeMixesBothSurfacesInOnePixelRow) {
  const Rig rig = small_head();
  const SimulateOptions options = quiet_options(rig);
  const double near = 1.6;
  const int row = 70;
  const double share = 0.75;  // of the row that lies on the box
  const double edge = (row + 0.5 - share + 1e-6 - rig.camera.cy) / 600 * near;
  SceneObject box = box_at({0, edge + 1, near + 5e-4}, {1, 2, 1e-3});
  const Image<double> mixed = clean_image({wall_at(2), box}, rig, options);
  const Image<double> far_only = clean_image({wall_at(2)}, rig, options);
  const Image<double> near_only = clean_image({wall_at(near)}, rig, options);
  for (int c = 0; c < mixed.cols; ++c) {
    EXPECT_NEAR(mixed.row(row - 2)[c], far_only.row(row - 2)[c], 1e-9);
    EXPECT_NEAR(mixed.row(row + 2)[c], near_only.row(row + 2)[c], 1e-9);
    const double expected = share * near_only.row(row)[c] + (1 - share) * far_only.row(row)[c];
    EXPECT_NEAR(mixed.row(row)[c], expected, 0.01) << c;
  }
}

TEST(SimulateFrame, AmbientLightIsTheSameFromEveryPose) {
  const Rig rig = small_head();
  SimulateOptions options = quiet_options(rig);
  options.ambient = 50;
  SceneObject room;
  room.name = "room";
  room.shape = RoomShape{{4, 3, 5}};
  room.albedo = 0.6;
  const Scene scene = scene_with({room});
  const FrameRenderer renderer(scene, rig, options);
  for (const double angle : {0.0, 0.7, 2.0}) {
    const RigidTransform pose{Eigen::Quaterniond(Eigen::AngleAxisd(angle, Vector3d::UnitY())),
                              Vector3d(0.2, 0.1, 0)};
    for (const double signal : renderer.expected_signal(pose, false).pixels) {
      ASSERT_NEAR(signal, 0.6 * 50, 1e-9);
    }
  }
}

// A turntable's object turned by hand under a still head, against the head moved about the object.
TEST(SimulateFrame, TurntableFrameShowsTheTurnedObject) {
  Rig rig = read_rig(shipped_data("rigs/ciclop_turntable.toml"));
  rig.camera.width = 320;
  rig.camera.height = 240;
  rig.camera.fx = rig.camera.fy = 360;
  rig.camera.cx = 160;
  rig.camera.cy = 120;
  const SimulateOptions options = options_for(rig);
  const double angle = 0.8;
  const Scene still = read_scene(shipped_data("scenes/turntable_object.toml"));
  std::vector<SceneObject> objects = still.objects();
  RigidTransform turn;
  turn.rotation = Eigen::AngleAxisd(angle, Vector3d::UnitZ());
  for (SceneObject& object : objects) object.world_from_object = turn * object.world_from_object;
  const Scene turned = scene_with(objects);
  const Image<double> moved_head =
      FrameRenderer(still, rig, options).expected_signal(rig.axis.scan_from_camera_at(angle), true);
  const Image<double> turned_object =
      FrameRenderer(turned, rig, options).expected_signal(rig.axis.scan_from_camera_at(0), true);
  std::size_t different = 0;  // but for rays that graze an edge
  for (std::size_t i = 0; i < moved_head.pixels.size(); ++i) {
    different += std::abs(moved_head.pixels[i] - turned_object.pixels[i]) > 1e-3 ? 1 : 0;
  }
  EXPECT_LT(different, 10U);
  EXPECT_GT(*std::max_element(moved_head.pixels.begin(), moved_head.pixels.end()), 100);
}

TEST(SimulateFrame, WallOfTrianglesShowsWhatAWallOfClosedFormShows) {
  const Rig rig = small_head();
  SimulateOptions options = quiet_options(rig);
  options.ambient = 10;
  SceneObject triangles = box_at({0, 0, 2}, {1, 1, 1});
  MeshShape wall;
  wall.mesh.vertices = {{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}};
  wall.mesh.triangles = {{0, 2, 1}, {0, 3, 2}};
  triangles.shape = wall;
  const Image<double> mesh = clean_image({triangles}, rig, options);
  const Image<double> box = clean_image({wall_at(2)}, rig, options);
  for (std::size_t i = 0; i < mesh.pixels.size(); ++i) {
    ASSERT_NEAR(mesh.pixels[i], box.pixels[i], 1e-9);
  }
}

// Every pixel against 12 x 12 rays of the test's own, shadows included, in a cluttered view.
TEST(SimulateFrame, NoLitPixelIsMissedInAClutteredView) {
  const Rig rig = small_head();
  SimulateOptions options = quiet_options(rig);
  options.ambient = 20;
  std::vector<SceneObject> objects = {wall_at(2.5), box_at({0.02, 0.1, 1.9}, {0.1, 0.1, 0.1})};
  SceneObject ball = box_at({0, -0.08, 1.7}, {1, 1, 1});
  ball.shape = SphereShape{0.07};
  ball.albedo = 0.5;
  objects.push_back(ball);
  const Scene scene = scene_with(objects);
  const Image<double> image = FrameRenderer(scene, rig, options).expected_signal({}, true);
  const Vector3d laser(0.25 / rig.lasers[0].normal.x(), 0, 0);
  constexpr int kGrid = 12;
  double worst = 0;
  double mean = 0;
  for (int r = 0; r < image.rows; ++r) {
    for (int c = 0; c < image.cols; ++c) {
      double sum = 0;
      for (int i = 0; i < kGrid * kGrid; ++i) {
        const double u = c - 0.5 + (i % kGrid + 0.5) / kGrid;
        const int step = i / kGrid;
        const double v = r - 0.5 + (step + 0.5) / kGrid;
        const Vector3d d = Vector3d((u - 119.5) / 600, (v - 59.5) / 600, 1).normalized();
        const auto hit = scene.first_hit(Vector3d::Zero(), d);
        const double albedo = scene.objects()[hit->object].albedo;
        sum += albedo * options.ambient;
        if (scene.occluded(hit->point, laser)) continue;
        const Vector3d way = laser - hit->point;
        const double w = options.line_half_width + options.line_divergence * way.norm();
        const double w1 = options.line_half_width + options.line_divergence;
        const double s = rig.lasers[0].normal.dot(hit->point) - 0.25;
        sum += albedo * options.laser_peak * std::max(hit->normal.dot(way) / way.norm(), 0.0) * w1 /
               w * std::exp(-s * s / (2 * w * w));
      }
      const double error = std::abs(image.row(r)[c] - sum / (kGrid * kGrid));
      worst = std::max(worst, error);
      mean += error / static_cast<double>(image.pixels.size());
    }
  }
  // At edges through a pixel four sub-pixels each way may be an eighth of the step off.
  EXPECT_LT(worst, 0.125 * 170 * 1.3);
  EXPECT_LT(mean, 0.02);
}

TEST(SimulateOptions, NameTheFieldThatCannotBe) {
  const Rig rig = small_head();
  SimulateOptions options = options_for(rig);
  options.read_noise = -1;
  EXPECT_NE(error_of([&] { options.check(); }).find("read_noise"), std::string::npos);
  options = options_for(rig);
  options.laser_origin.x() = NAN;
  EXPECT_NE(error_of([&] { options.check(); }).find("laser_origin"), std::string::npos);
  options = options_for(rig);
  options.laser = 1;
  EXPECT_NE(error_of([&] { laser_fan(rig, options); }).find("sheet 1"), std::string::npos);
}

}  // namespace
}  // namespace facula
