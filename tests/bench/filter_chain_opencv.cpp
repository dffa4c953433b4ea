// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/tests/bench/filter_chain_opencv.hpp>

#include <algorithm>

#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>

namespace facula {
namespace {

constexpr double kThreshold = 50;  // [DN]
constexpr int kReach = 8;          // [px]

void smooth_runs(std::vector<float>& position) {
  std::size_t first = 0;
  while (first < position.size()) {
    std::size_t last = first;
    while (last < position.size() && position[last] >= 0) ++last;
    if (last > first) {
      cv::Mat run(static_cast<int>(last - first), 1, CV_32F, position.data() + first);
      cv::GaussianBlur(run, run, cv::Size(1, 0), 0, 2, cv::BORDER_REPLICATE);
    }
    first = last + 1;
  }
}

}  // namespace

void filter_chain_on_one_thread() {
  cv::setNumThreads(1);
}

std::vector<float> filter_chain(ImageView8 grey) {
  const cv::Mat frame(grey.rows,
                      grey.cols,
                      CV_8U,
                      const_cast<std::uint8_t*>(grey.data),
                      static_cast<std::size_t>(grey.stride));
  cv::Mat image;
  cv::threshold(frame, image, kThreshold, 255, cv::THRESH_TOZERO);
  cv::blur(image, image, cv::Size(5, 5));
  cv::threshold(image, image, kThreshold, 255, cv::THRESH_TOZERO);
  cv::Mat brightest;
  cv::reduceArgMax(image, brightest, 1);
  std::vector<float> position(static_cast<std::size_t>(grey.rows), -1.0F);
  for (int r = 0; r < grey.rows; ++r) {
    const int middle = brightest.at<int>(r);
    const std::uint8_t* row = image.ptr(r);
    int weight = 0;
    int moment = 0;
    const int last = std::min(grey.cols - 1, middle + kReach);
    for (int c = std::max(0, middle - kReach); c <= last; ++c) {
      weight += row[c];
      moment += row[c] * c;
    }
    if (weight > 0) {
      position[static_cast<std::size_t>(r)] =
          static_cast<float>(moment) / static_cast<float>(weight);
    }
  }
  smooth_runs(position);
  return position;
}

}  // namespace facula
