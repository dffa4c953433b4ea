// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/tests/bench/accuracy/study.hpp>

#include <cstdint>
#include <filesystem>

namespace facula {

struct StudyOptions {
  std::filesystem::path data;  ///< the project's data folder
  std::uint64_t seed = 1;
  bool small = false;  ///< few trials, only to see that it runs
};

Study study_source_a(const StudyOptions& options);  ///< the self-made pan head
Study study_source_b(const StudyOptions& options);  ///< 3D laser radar: tables 3.5 to 3.8
Study study_source_c(const StudyOptions& options);  ///< two perpendicular planes
Study study_source_d(const StudyOptions& options);  ///< profiles: stack, polygons, rods
Study study_source_e(const StudyOptions& options);  ///< two-line rangefinder, air and water
Study study_sigma(const StudyOptions& options);     ///< is every point's sigma honest?
Study study_planes(const StudyOptions& options);    ///< planes and flatness of real scans

}  // namespace facula
