// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <sstream>
#include <string>

#include <Eigen/Core>

namespace facula {

/// A place or direction as sentences show it: "(1.5, -0.24, 0.6)".
template <typename Derived>
std::string place_text(const Eigen::MatrixBase<Derived>& x) {
  std::ostringstream text;
  text << '(' << x[0] << ", " << x[1] << ", " << x[2] << ')';
  return text.str();
}

}  // namespace facula
