// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>

namespace facula {

/// Called from time to time by work that takes long, by one thread at a time: `done` of `total`
/// steps are finished. May be empty.
using Progress = std::function<void(std::size_t done, std::size_t total)>;

}  // namespace facula
