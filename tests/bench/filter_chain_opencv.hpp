// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/image_view.hpp>

#include <vector>

namespace facula {

/// Keeps OpenCV's functions on the thread that calls them.
void filter_chain_on_one_thread();

/// The line as the program Horus finds it, in OpenCV's own functions on one thread: threshold to
/// zero, 5 x 5 box blur, threshold again, the brightest column of each row, only +-8 columns about
/// it kept, centre of gravity per row; then a Gaussian of 2 rows along each unbroken run. Position
/// per row [px], -1 where there is none.
std::vector<float> filter_chain(ImageView8 grey);

}  // namespace facula
