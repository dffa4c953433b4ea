// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/image_view.hpp>
#include <facula/acquire/rig/rig.hpp>
#include <facula/acquire/stripe/channel.hpp>
#include <facula/acquire/stripe/column_gate.hpp>
#include <facula/acquire/stripe/hue_gate.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace facula {

enum class DetectorKind {
  kFirZeroCrossing,    ///< zero crossing of the Gaussian-smoothed derivative (Forest 2004; Steger
                       ///< 1998)
  kCentroid,           ///< centre of gravity of +-10 px about the brightest (source B, 2.3)
  kThresholdCentroid,  ///< centre of gravity of what exceeds a threshold (source D)
  kBrightestPixel,     ///< whole pixel (source B, 2.2)
  kMaximumThreshold,   ///< middle of the brightest pixels over a threshold (source D)
  kOneThreshold,       ///< mean of two crossings, 1/2 px (source D)
  kTwoThresholds,      ///< mean of four crossings, 1/4 px (source D)
  kParabola,           ///< parabola through three pixels (Naidu and Fisher 1991)
  kGauss,              ///< Gaussian through three pixels (Naidu and Fisher 1991)
  kLogGauss,           ///< weighted fit to the logarithm (Caruana 1986; Guo 2011)
  kBlaisRioux4,        ///< zero crossing of 4 pixels (Blais and Rioux 1986)
  kBlaisRioux8,        ///< zero crossing of 8 pixels (Blais and Rioux 1986)
  kSteger              ///< ridge in two dimensions (Steger 1998)
};

/// Part of the image that is searched; width or height 0 means up to the border.
struct ImageRegion {
  int x = 0;       ///< [px]
  int y = 0;       ///< [px]
  int width = 0;   ///< [px]
  int height = 0;  ///< [px]
};

struct StripeOptions {
  DetectorKind detector = DetectorKind::kFirZeroCrossing;
  Channel channel = Channel::kRedExcess;
  StripeDirection direction = StripeDirection::kPerRow;
  double sigma = 2.0;          ///< expected width of the line, standard deviation [px], 0.5 to 10
  double min_snr = 5.0;        ///< least filter response over its own noise [1], above 0
  double min_amplitude = 8;    ///< least height over the surroundings [DN], 0 to 255
  double max_width_ratio = 4;  ///< widest stripe kept, in units of sigma [1], above 1
  int min_run = 4;             ///< rows a stripe must hang together, gaps of 2 allowed [1], 1 = any
  int median_rows = 1;         ///< positions become the median of so many rows: 1 = off, or 3
  ImageRegion region;          ///< [px]
  int max_candidates = 1;      ///< places looked at per row, of which the best path along the
                               ///< stripe takes one, 1 = the strongest, up to 8 [1]
  LaserHue hue = LaserHue::kAny;  ///< candidates of another colour are dropped, see hue_gate.hpp
  double min_hue_share = 0.3;     ///< least share of the laser's colour in their light, 0 to 1 [1]

  /// Throws Error naming the field, its value and its bound.
  void check() const;
};

/// The stripe of one frame: an entry per image row (or column). Rows where no stripe stands out
/// from the noise are not seen; their other values are 0.
struct StripeProfile {
  std::vector<std::uint8_t> seen;       ///< 1 where the stripe was found [0 or 1]
  std::vector<float> position;          ///< along the row [px]
  std::vector<float> sigma;             ///< 1 standard deviation of position [px]
  std::vector<float> amplitude;         ///< height over the surroundings [DN]
  std::vector<float> width;             ///< standard deviation of the line's profile [px]
  std::vector<std::uint8_t> saturated;  ///< 1 where the core is clipped [0 or 1]
  float noise = 0;                      ///< of the image, estimated, 1 standard deviation [DN]

  static StripeProfile none(std::size_t rows);
  std::size_t size() const { return seen.size(); }
  std::size_t seen_count() const;
};

/// Finds the stripe in a frame. `background`, when not empty, is the same view without the laser
/// and is subtracted. Frames may be grey or colour, both alike; see StripeOptions::channel. Throws
/// Error on an empty frame, options out of range, or a background that does not fit the frame.
StripeProfile detect_stripe(ImageView8 frame, ImageView8 background, const StripeOptions& options);

/// The same within the columns of `gate`; with more to say about the frame: see stripe_choice.hpp.
StripeProfile detect_stripe(ImageView8 frame,
                            ImageView8 background,
                            const StripeOptions& options,
                            const ColumnGate& gate);

/// The detectors by the names people give them, the default first.
std::vector<std::string> detector_names();

/// One of detector_names().
DetectorKind detector_from_name(const std::string& name);
std::string to_string(DetectorKind kind);

}  // namespace facula
