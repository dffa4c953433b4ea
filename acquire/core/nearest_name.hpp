// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace facula {

/// The known name that `word` most likely was meant to be, for "did you mean ...?": the one with
/// the smallest edit distance, the first of equals. Empty when none is near, that is when more than
/// a third of its letters (at least one, at most three) would have to change.
std::string nearest_name(const std::string& word, const std::vector<std::string>& known);

}  // namespace facula
