// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/rig/toml_table.hpp>
#include <facula/acquire/stripe/stripe_detector.hpp>

#include <ostream>
#include <string>

namespace facula {

/// Reads a table [stripe] as capture.toml has it; what it does not name keeps its default. Throws
/// Error on an unknown key or a value out of range.
StripeOptions read_stripe_options(TomlTable table, StripeDirection direction);

/// Writes such a table, every option with full precision, so that read_stripe_options() gives back
/// the same. Whoever adds an option adds it to both: a stripe log has no other record of it.
void write_stripe_options(std::ostream& out, const StripeOptions& options);

/// A whole number of pixels from a TOML number. Throws Error naming `where`.
int whole_pixels(double value, const std::string& where);

}  // namespace facula
