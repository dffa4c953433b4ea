// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/stripe/stripe_detector.hpp>
#include <facula/acquire/stripe/stripe_windows.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace facula {
namespace {

constexpr int kReach = 40;  // rows without a stripe that keep a window beside those with one

int column_of(const StripeProfile& profile, std::size_t r) {
  return static_cast<int>(std::lround(profile.position[r]));
}

int centred(int column, int cols, int width) {
  return std::clamp(column - width / 2, 0, cols - width);
}

/// Windows of the rows between two found ones, or beside the only one.
void bridge(const std::vector<int>& found,
            const StripeProfile& profile,
            int cols,
            WindowPlaces& places) {
  const int rows = static_cast<int>(profile.size());
  const auto peak = [&](int r) { return column_of(profile, static_cast<std::size_t>(r)); };
  for (std::size_t i = 0; i <= found.size(); ++i) {
    const int above = i == 0 ? -1 : found[i - 1];
    const int below = i == found.size() ? rows : found[i];
    for (int r = above + 1; r < below; ++r) {
      const bool near =
          (above >= 0 && r - above <= kReach) || (below < rows && below - r <= kReach);
      if (!near) continue;
      int column = 0;
      if (above < 0) {
        column = peak(below);
      } else if (below == rows) {
        column = peak(above);
      } else {
        column = peak(above) + (peak(below) - peak(above)) * (r - above) / (below - above);
      }
      places.begin[static_cast<std::size_t>(r)] = centred(column, cols, places.width);
    }
  }
}

/// Copies the windows of one image into an image as wide as a window.
Image8 cut(ImageView8 image, const WindowPlaces& places, bool transpose) {
  if (image.empty()) return {};
  const auto pixel = static_cast<std::size_t>(image.channels);
  Image8 out(transpose ? image.cols : image.rows, places.width, image.channels);
  for (int r = 0; r < out.rows; ++r) {
    const int begin = places.begin[static_cast<std::size_t>(r)];
    if (begin < 0) continue;
    if (!transpose) {
      std::memcpy(out.row(r),
                  image.row(r) + static_cast<std::size_t>(begin) * pixel,
                  static_cast<std::size_t>(out.stride()));
      continue;
    }
    for (int c = 0; c < places.width; ++c) {
      std::memcpy(out.row(r) + static_cast<std::size_t>(c) * pixel,
                  image.row(begin + c) + static_cast<std::size_t>(r) * pixel,
                  pixel);
    }
  }
  return out;
}

}  // namespace

std::size_t StripeWindows::kept_rows() const {
  return begin.size() -
         static_cast<std::size_t>(std::count(begin.begin(), begin.end(), std::int32_t{-1}));
}

void StripeWindows::check() const {
  require(begin.size() == static_cast<std::size_t>(lit.rows) &&
              (dark.empty() || (dark.rows == lit.rows && dark.cols == lit.cols)),
          "expected stripe windows with one beginning per row and a background of the same size, "
          "got ",
          begin.size(),
          " for ",
          lit.rows,
          " rows");
  for (const std::int32_t first : begin) {
    require(first >= -1 && (first < 0 || first + lit.cols <= cols),
            "expected stripe windows within rows of ",
            cols,
            " px, got one of ",
            lit.cols,
            " px that begins at ",
            first);
  }
}

int window_width(int row_pixels, int channels) {
  require(row_pixels > 0 && channels > 0, "expected rows with pixels, got rows of ", row_pixels);
  constexpr int kRowBytes = 8;  // what a log adds to the pixels of a row
  const int affordable = (row_pixels * channels * 118 / 1000 - kRowBytes) / channels / 8 * 8;
  return std::min(row_pixels, std::clamp(affordable, 48, 128));
}

WindowPlaces place_windows(const StripeProfile& profile, int cols, int width) {
  WindowPlaces places;
  places.width = std::min(width, cols);
  places.begin.assign(profile.size(), -1);
  std::vector<int> found;
  for (std::size_t r = 0; r < profile.size(); ++r) {
    if (profile.seen[r] == 0) continue;
    found.push_back(static_cast<int>(r));
    places.begin[r] = centred(column_of(profile, r), cols, places.width);
  }
  if (!found.empty()) bridge(found, profile, cols, places);
  return places;
}

StripeWindows cut_windows(ImageView8 frame,
                          ImageView8 background,
                          const WindowPlaces& places,
                          bool transpose) {
  require(background.empty() || (background.rows == frame.rows && background.cols == frame.cols),
          "expected a background of the frame's size");
  require(places.begin.size() == static_cast<std::size_t>(transpose ? frame.cols : frame.rows),
          "expected a window place for every row of the frame");
  StripeWindows windows;
  windows.cols = transpose ? frame.rows : frame.cols;
  windows.begin = places.begin;
  windows.lit = cut(frame, places, transpose);
  windows.dark = cut(background, places, transpose);
  windows.check();
  return windows;
}

}  // namespace facula
