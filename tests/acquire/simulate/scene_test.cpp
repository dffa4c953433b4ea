// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/random.hpp>
#include <facula/acquire/simulate/scene.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/meshes.hpp>
#include <facula/tests/support/real_data.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <cmath>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace facula {
namespace {

using Eigen::Vector3d;

SceneObject object(Shape shape, const Vector3d& at, const Vector3d& turn = Vector3d::Zero()) {
  SceneObject result;
  result.name = "thing";
  result.shape = std::move(shape);
  result.world_from_object.translation = at;
  if (turn.norm() > 0) {
    result.world_from_object.rotation =
        Eigen::Quaterniond(Eigen::AngleAxisd(turn.norm(), turn.normalized()));
  }
  return result;
}

Scene scene_of(SceneObject only) {
  std::vector<SceneObject> objects;
  objects.push_back(std::move(only));
  return Scene(std::move(objects));
}

Vector3d random_point(Random& random, double half) {
  return half *
         Vector3d(2 * random.uniform() - 1, 2 * random.uniform() - 1, 2 * random.uniform() - 1);
}

Vector3d random_direction(Random& random) {
  return Vector3d(random.normal(), random.normal(), random.normal()).normalized();
}

// A cuboid out of twelve triangles.
MeshShape cuboid_mesh(const Vector3d& size) {
  const Eigen::Vector3f edges = size.cast<float>();
  MeshShape shape{box_mesh(edges.x(), edges.y(), edges.z())};
  for (Eigen::Vector3f& vertex : shape.mesh.vertices) vertex -= edges / 2;
  return shape;
}

TEST(Scene, SphereIsHitWhereTheQuadraticSaysToATenthOfANanometreAtSixMetres) {
  const Vector3d centre(5.3, 2.1, -1.9);
  const double radius = 0.37;
  const Scene scene = scene_of(object(SphereShape{radius}, centre));
  Random random(3);
  int hits = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vector3d direction = (centre + 1.5 * radius * random_direction(random)).normalized();
    const double b = direction.dot(centre);
    const double discriminant = b * b - centre.squaredNorm() + radius * radius;
    if (std::abs(discriminant) < 1e-4) continue;  // grazing: the root is ill-conditioned
    const auto hit = scene.first_hit(Vector3d::Zero(), direction);
    ASSERT_EQ(hit.has_value(), discriminant > 0);
    if (!hit) continue;
    ++hits;
    EXPECT_NEAR(hit->distance, b - std::sqrt(discriminant), 1e-10);
    EXPECT_TRUE(is_near_point(hit->normal, (hit->point - centre) / radius, 1e-9));
  }
  EXPECT_GT(hits, 500);
}

TEST(Scene, RoomIsHitAtItsNearestWallFromInside) {
  const Vector3d size(6, 4.5, 2.6);
  const Scene scene = scene_of(object(RoomShape{size}, {0, 0, 1.3}));
  Random random(5);
  for (int i = 0; i < 1000; ++i) {
    const Vector3d origin = random_point(random, 1.0) + Vector3d(0, 0, 1.3);
    const Vector3d d = random_direction(random);
    double nearest = 1e9;
    for (int k = 0; k < 3; ++k) {
      const double wall = (d[k] > 0 ? 0.5 : -0.5) * size[k] + (k == 2 ? 1.3 : 0);
      nearest = std::min(nearest, (wall - origin[k]) / d[k]);
    }
    const auto hit = scene.first_hit(origin, d);
    ASSERT_TRUE(hit.has_value());
    EXPECT_NEAR(hit->distance, nearest, 1e-12);
    EXPECT_LT(hit->normal.dot(d), 0) << "the normal must look towards the ray's origin";
    EXPECT_NEAR(hit->normal.norm(), 1, 1e-12);
  }
}

// The first hit must lie on the surface (by an equation of its own) and nothing before it may.
TEST(Scene, TurnedCylinderIsHitOnItsSurfaceAndNotLater) {
  const Vector3d at(2, -1, 0.5);
  const Vector3d turn(0.4, 1.1, -0.3);
  const SceneObject thing = object(CylinderShape{0.3, 0.8}, at, turn);
  const RigidTransform object_from_world = thing.world_from_object.inverse();
  const Scene scene = scene_of(thing);
  const auto excess = [&](const Vector3d& x) {  // above 0 outside
    const Vector3d p = object_from_world * x;
    return std::max(std::hypot(p.x(), p.y()) - 0.3, std::abs(p.z()) - 0.4);
  };
  Random random(11);
  int hits = 0;
  for (int i = 0; i < 1000; ++i) {
    const Vector3d direction = (at + 0.6 * random_direction(random)).normalized();
    const auto hit = scene.first_hit(Vector3d::Zero(), direction);
    const double end = hit ? hit->distance : 5.0;
    for (double t = 0; t < end - 1e-6; t += 0.01) ASSERT_GT(excess(t * direction), 0);
    if (!hit) continue;
    ++hits;
    EXPECT_NEAR(excess(hit->point), 0, 1e-12);
  }
  EXPECT_GT(hits, 200);
}

TEST(Scene, MeshOfABoxAnswersAsTheBoxDoes) {
  const Vector3d size(0.5, 0.25, 1.0);  // exact in float
  const Vector3d at(1, 0.5, -0.25);
  const Scene box = scene_of(object(BoxShape{size}, at));
  const Scene mesh = scene_of(object(cuboid_mesh(size), at));
  Random random(7);
  int hits = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vector3d x = at + random_point(random, 1.0);
    EXPECT_NEAR(mesh.distance(x), box.distance(x), 1e-12);
    EXPECT_EQ(mesh.inside(x), box.inside(x)) << x.transpose();
    const Vector3d origin(-2, -1, 2);
    const Vector3d direction = (at + random_point(random, 0.7) - origin).normalized();
    const auto a = box.first_hit(origin, direction);
    const auto b = mesh.first_hit(origin, direction);
    ASSERT_EQ(a.has_value(), b.has_value());
    if (!a) continue;
    ++hits;
    EXPECT_NEAR(b->distance, a->distance, 1e-12);
    EXPECT_TRUE(is_near_point(b->normal, a->normal, 1e-12));
  }
  EXPECT_GT(hits, 500);
}

TEST(Scene, DistanceEqualsTheNearestOfManySurfacePoints) {
  const Vector3d turn(0.2, -0.7, 0.5);
  std::vector<SceneObject> objects;
  objects.push_back(object(BoxShape{{0.4, 0.3, 0.2}}, {0.5, 0, 0}, turn));
  objects.push_back(object(CylinderShape{0.15, 0.5}, {-0.4, 0.2, 0.1}, turn));
  objects.push_back(object(SphereShape{0.2}, {0, -0.5, 0.2}));
  const std::vector<SceneObject> copy = objects;
  const Scene scene(std::move(objects));
  std::vector<Vector3d> surface;
  constexpr double kPitch = 0.01;
  for (double u = 0; u <= 1; u += 0.02) {
    for (double v = 0; v <= 1; v += 0.02) {
      const double a = 2 * M_PI * u;
      for (int k = 0; k < 3; ++k) {
        Vector3d p((u - 0.5) * 0.4, (v - 0.5) * 0.3, 0.1);
        if (k == 1) p = Vector3d((u - 0.5) * 0.4, 0.15, (v - 0.5) * 0.2);
        if (k == 2) p = Vector3d(0.2, (u - 0.5) * 0.3, (v - 0.5) * 0.2);
        surface.emplace_back(copy[0].world_from_object * p);
        surface.emplace_back(copy[0].world_from_object * Vector3d(-p));
      }
      const Vector3d side(0.15 * std::cos(a), 0.15 * std::sin(a), (v - 0.5) * 0.5);
      surface.emplace_back(copy[1].world_from_object * side);
      const Vector3d lid(v * 0.15 * std::cos(a), v * 0.15 * std::sin(a), 0.25);
      surface.emplace_back(copy[1].world_from_object * lid);
      surface.emplace_back(copy[1].world_from_object * Vector3d(-lid));
      const double b = M_PI * v;
      surface.emplace_back(copy[2].world_from_object * Vector3d(0.2 * std::sin(b) * std::cos(a),
                                                                0.2 * std::sin(b) * std::sin(a),
                                                                0.2 * std::cos(b)));
    }
  }
  Random random(13);
  for (int i = 0; i < 300; ++i) {
    const Vector3d x = random_point(random, 1.0);
    double nearest = 1e9;
    for (const Vector3d& p : surface) nearest = std::min(nearest, (x - p).norm());
    EXPECT_LE(scene.distance(x), nearest + 1e-12);
    EXPECT_GE(scene.distance(x), nearest - 2 * kPitch);
  }
}

TEST(Scene, SurfaceCrossingsToFarAwayTellInsideFromOutside) {
  std::vector<SceneObject> objects;
  objects.push_back(object(RoomShape{{4, 4, 3}}, {0, 0, 0}));
  objects.push_back(object(BoxShape{{1, 1, 1}}, {1, 0, 0}, {0, 0, 0.6}));
  objects.push_back(object(CylinderShape{0.3, 1}, {-1, 0.2, 0}, {0.5, 0, 0}));
  const Scene scene(std::move(objects));
  Random random(17);
  for (int i = 0; i < 500; ++i) {
    const Vector3d x = random_point(random, 2.5);
    int crossings = 0;  // an odd number lies between matter and the room's air or the like
    Vector3d at = x;
    const Vector3d direction = random_direction(random);
    while (const auto hit = scene.first_hit(at, direction)) {
      ++crossings;
      at = hit->point + 1e-5 * direction;
    }
    EXPECT_EQ(scene.inside(x), crossings % 2 == 0) << x.transpose();
  }
}

TEST(Scene, OnlyWhatLiesBetweenTwoPointsOccludes) {
  const Scene scene = scene_of(object(BoxShape{{1, 1, 1}}, {2, 0, 0}));
  EXPECT_TRUE(scene.occluded({0, 0, 0}, {4, 0, 0}));
  EXPECT_FALSE(scene.occluded({0, 0, 0}, {1.5, 0, 0})) << "the end's own surface is not in the way";
  EXPECT_FALSE(scene.occluded({1.5, 0, 0}, {0, 0, 0}));
  EXPECT_FALSE(scene.occluded({0, 0, 0}, {1.2, 0, 0}));
  EXPECT_TRUE(scene.occluded({1.5, 0, 0}, {3, 0.1, 0.1})) << "its far side is";
  EXPECT_FALSE(scene.occluded({0, 0.6, 0}, {4, 0.6, 0}));
}

TEST(Scene, RefusesImpossibleShapesAndColours) {
  EXPECT_NE(error_of([] { scene_of(object(SphereShape{-1}, Vector3d::Zero())); }).find("radius"),
            std::string::npos);
  EXPECT_NE(error_of([] {
              scene_of(object(BoxShape{{1, NAN, 1}}, Vector3d::Zero()));
            }).find("edge length"),
            std::string::npos);
  EXPECT_NE(error_of([] { scene_of(object(MeshShape{}, Vector3d::Zero())); }).find("triangle"),
            std::string::npos);
  SceneObject bright = object(SphereShape{1}, Vector3d::Zero());
  bright.albedo = 1.5;
  EXPECT_NE(error_of([&] { scene_of(bright); }).find("albedo"), std::string::npos);
}

TEST(ReadScene, TurnsAboutXThenYThenZ) {
  const TemporaryFolder folder;
  const auto path = folder.write("scene.toml",
                                 "[[object]]\nname = \"board\"\nshape = \"box\"\n"
                                 "size_mm = [2000, 1000, 100]\nposition_mm = [0, 0, 500]\n"
                                 "rotation_deg = [90, 0, 90]\nalbedo = 0.5\n");
  const Scene scene = read_scene(path);
  ASSERT_EQ(scene.objects().size(), 1U);
  EXPECT_EQ(scene.objects()[0].albedo, 0.5);
  // About x: y becomes z; then about z: x becomes y, y becomes -x. Length lies along y, width
  // along z, thickness along x.
  EXPECT_TRUE(scene.inside({0.04, 0.9, 0.9}));
  EXPECT_FALSE(scene.inside({0.06, 0.9, 0.9}));
  EXPECT_FALSE(scene.inside({0.04, 1.1, 0.9}));
  EXPECT_FALSE(scene.inside({0.04, 0.9, 1.1}));
}

TEST(ReadScene, NamesTheKeyThatIsWrong) {
  const TemporaryFolder folder;
  const auto misspelt = folder.write(
      "a.toml", "[[object]]\nname = \"x\"\nshape = \"sphere\"\nradius_mm = 5\nalbdo = 1\n");
  EXPECT_NE(error_of([&] { read_scene(misspelt); }).find("albedo"), std::string::npos);
  const auto shape = folder.write("b.toml", "[[object]]\nname = \"x\"\nshape = \"cone\"\n");
  EXPECT_NE(error_of([&] { read_scene(shape); }).find("cone"), std::string::npos);
  const auto empty = folder.write("c.toml", "\n");
  EXPECT_NE(error_of([&] { read_scene(empty); }).find("[[object]]"), std::string::npos);
}

TEST(ShippedScenes, LeaveTheHeadStationsFree) {
  const Scene room = read_scene(shipped_data("scenes/furnished_room.toml"));
  for (const Vector3d& station :
       {Vector3d(-1.5, -0.3, 1.1), Vector3d(0.2, 0.8, 1.1), Vector3d(1.7, -0.3, 1.1)}) {
    EXPECT_FALSE(room.inside(station));
    EXPECT_GT(room.distance(station), 0.5) << station.transpose();
  }
  EXPECT_GT(read_scene(shipped_data("scenes/turntable_object.toml")).objects().size(), 5U);
  EXPECT_NEAR(
      read_scene(shipped_data("scenes/flat_wall.toml")).distance(Vector3d::Zero()), 2, 1e-12);
}

}  // namespace
}  // namespace facula
