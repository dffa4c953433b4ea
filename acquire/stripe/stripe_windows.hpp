// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/image_view.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace facula {

struct StripeProfile;

/// The pixels of a frame about its stripe: of every row (column, where the stripe runs per column)
/// one window of `lit.cols` pixels, as they came from the camera. The same window is kept of the
/// background where there is one.
struct StripeWindows {
  int cols = 0;                     ///< of the frame, along the windows [px]
  std::vector<std::int32_t> begin;  ///< first column per row, -1 where nothing is kept [px]
  Image8 lit;                       ///< one row per row of the frame; zeros where nothing is kept
  Image8 dark;                      ///< laser off; empty where there is no background

  int rows() const { return lit.rows; }
  int width() const { return lit.cols; }
  std::size_t kept_rows() const;

  /// Throws Error when sizes do not fit one another or a window leaves the frame.
  void check() const;
};

/// Window width that keeps a log below 12 % of frames with rows of `row_pixels` [px] and
/// `channels`: at most 128 px, at least 48 (which is more than 12 % of rows shorter than 460 px),
/// never more than the row [px].
int window_width(int row_pixels, int channels);

/// Where the windows of a frame begin.
struct WindowPlaces {
  int width = 0;                    ///< [px]
  std::vector<std::int32_t> begin;  ///< first column per row, -1 for no window [px]
};

/// Places windows of `width` along rows of `cols` pixels. Rows where the stripe was seen have it in
/// their window's middle. Rows up to 40 off take the place that these say, along a line that is
/// straight between them, so that another detector finds there what this one missed; the others
/// keep nothing.
WindowPlaces place_windows(const StripeProfile& profile, int cols, int width);

/// Cuts the windows out of a frame and its background (may be empty). `transpose` turns columns
/// into rows.
StripeWindows cut_windows(ImageView8 frame,
                          ImageView8 background,
                          const WindowPlaces& places,
                          bool transpose);

}  // namespace facula
