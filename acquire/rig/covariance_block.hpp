// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/rig/rig.hpp>

#include <string>
#include <vector>

#include <Eigen/Core>

namespace facula {

/// Puts the covariance of a newly calibrated part into the rig's: what the rig had said of
/// parameters that begin with `part` ("camera.", "laser.red.") is dropped, all others stay, and the
/// two are taken as independent of each other. Parameters of variance 0 were not estimated and are
/// left out.
void replace_covariance(Rig& rig,
                        const std::string& part,
                        const std::vector<std::string>& names,
                        const Eigen::MatrixXd& covariance);

}  // namespace facula
