// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace facula {

/// What the light, the lens, the sensor, and the axis of a simulated head do wrong. Everything is
/// off by default. docs/simulated_head.md derives each term and says where its size comes from.

/// Which channels of a colour camera see the laser, and which colour of a surface sends it back.
enum class LaserColour {
  kRed,      ///< 630 to 660 nm
  kGreen,    ///< 520 to 532 nm
  kInfrared  ///< 780 to 850 nm: all dyes of the sensor let it through, all surfaces are grey
};

/// A beam focused across the sheet: at distance r from the laser its radius to 1/e^2 of the peak is
/// w(r) = waist sqrt(1 + ((r - focus) / z_R)^2), z_R = pi waist^2 / (M^2 wavelength), and the
/// standard deviation w / 2.
struct GaussianBeam {
  double waist = 200e-6;       ///< least radius to 1/e^2 [m]
  double focus = 1.0;          ///< distance of the waist from the laser [m]
  double wavelength = 650e-9;  ///< [m]
  double quality = 1.0;        ///< M^2, 1 for the perfect beam [1]

  /// Standard deviation of the sheet at a distance from the laser [m].
  double half_width(double from_laser) const;
};

/// The grain that laser light has on a rough surface. Grains on the sensor have the size of the
/// lens' diffraction spot, wavelength * f_number * (1 + magnification); a pixel averages those that
/// fall into it.
struct Speckle {
  double wavelength = 650e-9;  ///< [m]
  double f_number = 2.8;       ///< focal length over the diameter of the aperture [1]
  double magnification = 0;    ///< image size over object size, about f / distance [1]
  double pixel_pitch = 3e-6;   ///< [m]
  /// Independent patterns that add up within the exposure: 2 for a surface that depolarises, more
  /// for a diode with several modes [1].
  double averages = 2;

  /// lambda N (1 + m) over the pixel pitch [px].
  double grain() const;

  /// Standard deviation over mean of the light in one pixel [1].
  double contrast() const;

  /// Correlation of the light in two pixels that are `distance` apart along a row or column [1].
  double correlation(double distance) const;
};

/// What the lens does to the image beside its projection.
struct Lens {
  double blur = 0;         ///< point spread, standard deviation [px]
  double glare_share = 0;  ///< share of the light that is scattered widely [0..1]
  double glare_blur = 25;  ///< how widely, standard deviation [px]
  double vignetting = 0;   ///< power of the cosine of the angle off the axis, 4 = cos^4 law [1]
};

/// When exposures happen. A step of the axis takes its exposures one after the other: dark, lit and
/// dark again, as far as they are asked for.
struct Timing {
  double frame_interval = 1.0 / 30;  ///< from one exposure to the next [s]
  double exposure_time = 0.005;      ///< [s]
  double row_time = 0;               ///< delay from row to row of a rolling shutter [s]
};

/// Lamps on the mains: their light is 1 + depth cos(2 pi frequency t + phase).
struct MainsFlicker {
  double depth = 0;        ///< (greatest - least) / (greatest + least) [0..1]
  double frequency = 100;  ///< twice the mains frequency [Hz]
  double phase = 0;        ///< [rad]
};

/// How far the axis is from where it was sent. Positions in rad or m, as the axis counts.
struct AxisErrors {
  double noise = 0;               ///< of each position, 1 standard deviation
  double periodic_amplitude = 0;  ///< of an error sin(2 pi position / period + phase)
  double period = 1;              ///< of that error, in units of position, above 0
  double phase = 0;               ///< of that error [rad]
  double backlash = 0;            ///< play: after a reversal the axis stands still for this way
  double speed = 0;               ///< while frames are taken, per second; 0 = it stops for each
  double latency = 0;             ///< the frame shows the axis this much after its position [s]
};

}  // namespace facula
