// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace facula {

/// One stripe in one row, before it is judged against the noise of the whole frame.
struct StripeCandidate {
  float position = 0;          ///< [px]
  float amplitude = 0;         ///< height over the surroundings [DN]
  float background = 0;        ///< level of the surroundings [DN]
  float width = 0;             ///< standard deviation of the profile [px]
  float row_noise = 0;         ///< of this row, as the detector's filter sees it [DN]
  float snr_per_noise = 0;     ///< response over its standard deviation for noise of 1 DN [1/DN]
  float sigma_per_noise = 0;   ///< standard deviation of position for noise of 1 DN [px/DN]
  float sigma_step = 0;        ///< part of the standard deviation that no light removes: the
                               ///< detector's own steps or bias [px]
  float residual = 0;          ///< mean square left by the fitted profile [DN^2]
  float residual_freedom = 0;  ///< degrees of freedom of that mean [1], 0 where none was taken
  float residual_share = 0;  ///< of a variance that follows the signal: its mean where the residual
                             ///< is taken over its value at the amplitude [1]
  float position_share = 0;  ///< the same where the position is taken from [1]
  bool saturated = false;    ///< the core is clipped
};

}  // namespace facula
