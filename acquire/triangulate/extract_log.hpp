// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/log/stripe_log_reader.hpp>
#include <facula/acquire/triangulate/extract_scan.hpp>

namespace facula {

/// The scan that a stripe log holds, bit for bit the one that was extracted while it was written.
/// `capture` says how: log.settings() for the same scan, or that with another detector or a newer
/// rig put in. One column per frame up to the last one recorded; columns of damaged or missing
/// records stay empty. Reads the log once, one record at a time per thread. `options.log` is not
/// looked at. Throws Error when no record can be used, or the rig's camera is of another size or
/// its stripe runs another way than the log's.
ExtractResult extract_scan(const StripeLogReader& log,
                           const Capture& capture,
                           const ExtractOptions& options = {});

}  // namespace facula
