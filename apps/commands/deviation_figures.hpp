// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/figures.hpp>
#include <facula/reconstruct/measure/deviation.hpp>

namespace facula {

/// Count, mean, standard deviation, median, rms, 95 %, largest, and who was left out.
void report_deviations(const Deviations& deviations, Figures& figures);

/// How often which deviation occurs.
FigureTable deviation_table(const Deviations& deviations);

}  // namespace facula
