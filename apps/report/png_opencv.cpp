// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/atomic_file.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/apps/report/png.hpp>

#include <vector>

#include <opencv2/imgcodecs.hpp>

namespace facula {

std::string encode_png(const Image8& picture) {
  require(!picture.empty() && (picture.channels == 1 || picture.channels == 3),
          "a PNG needs a picture of 1 or 3 channels, not ",
          picture.cols,
          " x ",
          picture.rows,
          " px with ",
          picture.channels,
          " channels");
  // OpenCV has no read-only header over foreign pixels; imencode does not write to it.
  const cv::Mat header(picture.rows,
                       picture.cols,
                       CV_8UC(picture.channels),
                       const_cast<std::uint8_t*>(picture.pixels.data()));
  std::vector<std::uint8_t> bytes;
  require(cv::imencode(".png", header, bytes), "the picture could not be written as PNG");
  return {bytes.begin(), bytes.end()};
}

void write_png(const std::filesystem::path& path, const Image8& picture) {
  const std::string bytes = encode_png(picture);
  AtomicFile file(path);
  file.stream().write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.commit();
}

}  // namespace facula
