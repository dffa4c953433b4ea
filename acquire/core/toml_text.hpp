// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace facula {

/// A TOML string in double quotes; quotes, backslashes and control characters are escaped, so that
/// every text reads back as it was.
std::string toml_quoted(const std::string& text);

}  // namespace facula
