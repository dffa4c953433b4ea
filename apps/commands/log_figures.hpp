// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/log/stripe_log_reader.hpp>
#include <facula/acquire/triangulate/extract_scan.hpp>
#include <facula/apps/cli/figures.hpp>

namespace facula {

/// How large a log is beside the frames it stands for, and what of it was lost.
void report_log(const LogFigures& log, Figures& figures);

/// What facula info says about a log; reads every record to see whether it is sound.
void describe(const StripeLogReader& log, Figures& figures);

}  // namespace facula
