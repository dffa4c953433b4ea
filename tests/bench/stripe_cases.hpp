// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/tests/acquire/stripe/cramer_rao.hpp>
#include <facula/tests/acquire/stripe/position_errors.hpp>

#include <string>
#include <vector>

namespace facula {

/// One setting of the precision table.
struct PrecisionCase {
  std::string name;
  std::string table;                ///< "grid" or "special"
  LineImage line;                   ///< drawn in images of 1000 rows, each with its own seed
  std::function<bool(int)> counts;  ///< rows that count, all where empty
  double expected = 0;              ///< width the detectors are told, 0 = the line's own [px]
};

/// Widths 1, 2, 4 px, heights 40, 60, 100, 200 and 800 (clipped) DN, noise 1, 2, 4 DN; then lines
/// of another width than expected, lines that lean, ambient ramps, photon noise and depth steps.
std::vector<PrecisionCase> precision_cases();

struct PrecisionResult {
  LineBound bound;
  std::vector<PositionErrors> errors;  ///< by detector, in the order of detector_names()
};

/// At least `trials` rows of a case, found by every detector.
PrecisionResult measure_case(const PrecisionCase& which, int trials);

}  // namespace facula
