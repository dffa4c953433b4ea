// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>
#include <facula/acquire/core/triangle_mesh.hpp>

namespace facula {

// CGAL's surface reconstructions beside advancing front (meshing.hpp). All take the finite points
// of a cloud and throw Error where they hold no surface.

struct PoissonOptions {
  double spacing = 0;       ///< of the points that are solved for [m]; 0 = from the sampling
  double min_angle = 0.35;  ///< least angle of a triangle [rad], below 0.52
  double size = 1.5;        ///< largest circumradius of a triangle [spacings]
  double error = 0.25;      ///< distance of the mesh from the solution [spacings]

  void check() const;
};

/// A closed surface whose inside follows the points' normals (Kazhdan, Bolitho and Hoppe 2006, in
/// CGAL's form on an adaptive Delaunay grid; contoured by Delaunay refinement, Boissonnat and Oudot
/// 2005). Needs normals. It bridges what was not scanned.
TriangleMesh mesh_poisson(const PointCloud& cloud, const PoissonOptions& options = {});

struct ScaleSpaceOptions {
  int iterations = 2;   ///< smoothing steps before points are joined [1], at least 1
  int neighbours = 12;  ///< points of a smoothing step [1], at least 3
  double max_edge = 0;  ///< longest edge [m]; 0 = as for advancing front

  void check() const;
};

/// A surface through the points, joined at a smoother scale (Digne et al. 2011; weighted PCA and
/// advancing front, CGAL): for noisy clouds without normals. Triangles are turned to the sensor
/// origins or normals where the cloud has them.
TriangleMesh mesh_scale_space(const PointCloud& cloud, const ScaleSpaceOptions& options = {});

struct AlphaWrapOptions {
  double alpha = 0;   ///< gaps narrower than this are bridged [m]; 0 = 4 times the sampling
  double offset = 0;  ///< distance of the wrap from what it wraps [m]; 0 = a sixth of alpha

  void check() const;
};

/// A closed, manifold surface without self-intersections around the points, `offset` outside of
/// them (Portaneri et al. 2022, CGAL). Never fails on input that has an extent, but follows holes
/// wider than alpha to the inside.
TriangleMesh wrap_points(const PointCloud& cloud, const AlphaWrapOptions& options = {});

/// The same around the triangles of a mesh, of any quality. alpha and offset must be given.
TriangleMesh wrap_mesh(const TriangleMesh& mesh, const AlphaWrapOptions& options);

/// The finite points of a cloud with their attributes, one where several stand in one place. Throws
/// Error when fewer than 4 are finite, or all lie on one line or in one spot.
PointCloud surface_points(const PointCloud& cloud);

/// Long enough to reach over a few missing points and from stripe to stripe [m].
double reaching_edge(const PointCloud& cloud);

/// Turns a mesh whose vertices are points of the cloud (or near them) towards the points' sensor
/// origins, else along their normals, else to enclose a positive volume.
void orient_by_points(TriangleMesh& mesh, const PointCloud& cloud);

}  // namespace facula
