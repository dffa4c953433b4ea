// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/map/grid_image.hpp>

#include <opencv2/imgcodecs.hpp>

namespace facula {
namespace {

/// A PNG file without its last chunk, of which libpng would complain on the error stream.
bool is_torn_png(const std::string& bytes) {
  return bytes.starts_with("\x89PNG") && bytes.find("IEND", bytes.size() - 8) == std::string::npos;
}

/// OpenCV's message is for programmers, so it stays out of the sentence.
cv::Mat decoded(const std::string& bytes) {
  if (bytes.size() < 8 || is_torn_png(bytes)) return {};
  try {
    const auto length = static_cast<int>(bytes.size());
    const cv::Mat encoded(1, length, CV_8UC1, const_cast<char*>(bytes.data()));
    return cv::imdecode(encoded, cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception&) {
    return {};
  }
}

}  // namespace

void write_png(std::ostream& out, const GridImage& image) {
  cv::Mat picture(image.rows, image.cols, CV_8UC4);
  for (std::size_t i = 0; i < image.size(); ++i) {
    const std::uint8_t grey = image.grey[i];
    const std::uint8_t alpha = image.alpha.empty() ? std::uint8_t{255} : image.alpha[i];
    picture.at<cv::Vec4b>(static_cast<int>(i) / image.cols, static_cast<int>(i) % image.cols) = {
        grey, grey, grey, alpha};
  }
  std::vector<std::uint8_t> bytes;
  require(cv::imencode(".png", picture, bytes),
          "cannot encode a picture of ",
          image.cols,
          " x ",
          image.rows,
          " pixels as PNG");
  out.write(reinterpret_cast<const char*>(bytes.data()),
            static_cast<std::streamsize>(bytes.size()));
}

GridImage decode_grid_image(const std::string& bytes, const std::string& name) {
  const cv::Mat picture = decoded(bytes);
  require(!picture.empty(), "'", name, "' is not a picture that can be read; it may be torn");
  require(picture.depth() == CV_8U, "'", name, "': expected 8 bits per channel");
  const int channels = picture.channels();
  const int colours = channels == 2 || channels == 4 ? channels - 1 : channels;
  GridImage image;
  image.rows = picture.rows;
  image.cols = picture.cols;
  for (int row = 0; row < picture.rows; ++row) {
    const std::uint8_t* pixel = picture.ptr(row);
    for (int col = 0; col < picture.cols; ++col, pixel += channels) {
      int sum = 0;
      for (int k = 0; k < colours; ++k) sum += pixel[k];
      image.grey.push_back(static_cast<std::uint8_t>(sum / colours));
      if (colours < channels) image.alpha.push_back(pixel[colours]);
    }
  }
  return image;
}

}  // namespace facula
