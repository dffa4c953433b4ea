// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/figures.hpp>
#include <facula/map/map_query.hpp>

#include <optional>
#include <vector>

namespace facula {

/// A map and how questions about it are meant.
struct MapAnswers {
  const OccupancyMap& map;
  MapQuery query;
  UnknownCells unknown = UnknownCells::kOccupied;
  std::optional<double> radius;  ///< of balls about places, none: not asked [m]
  double max_range = 0;          ///< of rays, 0 = no limit [m]
};

struct QueryRay {
  Eigen::Vector3d from = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector3d to = Eigen::Vector3d::Zero();    ///< it goes on beyond [m]
};

void report_place(const MapAnswers& answers, const Eigen::Vector3d& x, Figures& figures);
void report_ray(const MapAnswers& answers, const QueryRay& ray, Figures& figures);
void report_box(const MapAnswers& answers, const MapBox& box, Figures& figures);

/// A row per place or ray; figures get the counts.
FigureTable table_of_places(const MapAnswers& answers,
                            const std::vector<Eigen::Vector3d>& places,
                            Figures& figures);
FigureTable table_of_rays(const MapAnswers& answers,
                          const std::vector<QueryRay>& rays,
                          Figures& figures);

}  // namespace facula
