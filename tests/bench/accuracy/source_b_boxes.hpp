// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/random.hpp>
#include <facula/acquire/range/compensation_table.hpp>
#include <facula/acquire/range/range_model.hpp>
#include <facula/acquire/rig/rig.hpp>
#include <facula/tests/bench/accuracy/study.hpp>

#include <filesystem>
#include <string>

namespace facula {

/// A head of source B and what the paper publishes about it.
struct SourceBHead {
  std::string name;
  std::filesystem::path rig;
  double nearest = 0;  ///< [m]
  std::filesystem::path curve_fit;
  std::filesystem::path compensation;
  double fs = 0;          ///< f·s [mm²]
  double slope = 0;       ///< A of tables 3.1 and 3.2, least squares [px mm]
  double asked_rate = 0;  ///< [%]
};

/// The head as it is calibrated: the paper's way and the joint way.
struct SourceBRigs {
  RangeModel curve;
  CompensationTable table;
  Rig joint;
};

struct BoxRates {
  StudyTable table;
  double worst_rate = 100;  ///< of the joint calibration and of the compensation [%]
};

/// Tables 3.7 and 3.8: three equal boxes at 1, 2 and 3 m, panned over in steps of 1 degree; a point
/// is correct when its range is within 1 % of the truth.
BoxRates scan_boxes(const Rig& truth,
                    const SourceBHead& head,
                    const SourceBRigs& rigs,
                    const std::filesystem::path& published,
                    Random& random);

}  // namespace facula
