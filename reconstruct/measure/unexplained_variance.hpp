// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

namespace facula {

/// The variance that, added to that of every residual, makes the sum of r^2 / variance as large as
/// its degrees of freedom; 0 where it is not larger without, or nothing is free. What the stated
/// sigmas leave unexplained (a surface that is not flat, sigmas that are too small), so that a few
/// points that claim to be sure do not decide a fit alone. `squares` are the residuals squared
/// [m^2], `variances` what is stated of them, above 0 [m^2]. Paule and Mandel, J. Res. NBS 87
/// (1982) 377.
double unexplained_variance(const std::vector<double>& squares,
                            const std::vector<double>& variances,
                            std::size_t degrees_of_freedom);

}  // namespace facula
