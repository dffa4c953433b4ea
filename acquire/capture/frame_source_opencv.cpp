// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/capture/frame_list.hpp>
#include <facula/acquire/capture/frame_source.hpp>
#include <facula/acquire/core/atomic_file.hpp>
#include <facula/acquire/core/error.hpp>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <deque>
#include <fstream>
#include <iterator>
#include <mutex>

#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

namespace facula {
namespace {

Image8 image_from(const cv::Mat& mat) {
  Image8 image(mat.rows, mat.cols, mat.channels());
  for (int r = 0; r < mat.rows; ++r) {
    std::memcpy(image.row(r), mat.ptr(r), static_cast<std::size_t>(image.stride()));
  }
  return image;
}

using Bytes = std::vector<std::uint8_t>;

/// The decoders fill what is missing at the end of a file with grey and only print a warning.
bool is_torn(const Bytes& bytes) {
  const auto tail_holds = [&](const Bytes& mark, std::size_t reach) {
    const auto from = bytes.end() - static_cast<std::ptrdiff_t>(std::min(reach, bytes.size()));
    return std::search(from, bytes.end(), mark.begin(), mark.end()) != bytes.end();
  };
  if (bytes.size() > 8 && bytes[0] == 0x89 && bytes[1] == 'P') {
    return !tail_holds({'I', 'E', 'N', 'D'}, 4096);
  }
  if (bytes.size() > 2 && bytes[0] == 0xFF && bytes[1] == 0xD8) {
    return !tail_holds({0xFF, 0xD9}, 4096);
  }
  return false;
}

Bytes read_bytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  require(file.is_open() && std::filesystem::is_regular_file(path),
          "there is no readable frame '",
          path.string(),
          "'");
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

class ImageFiles : public FrameSource {
 public:
  explicit ImageFiles(std::vector<std::filesystem::path> files) : files_(std::move(files)) {}
  std::size_t size() const override { return files_.size(); }
  Image8 read(std::size_t i) const override { return read_image(files_.at(i)); }

 private:
  std::vector<std::filesystem::path> files_;
};

/// OpenCV prints what each of its video libraries thinks of a file; a library does not print.
class QuietOpenCv {
 public:
  QuietOpenCv() : before_(cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT)) {}
  ~QuietOpenCv() { cv::utils::logging::setLogLevel(before_); }
  QuietOpenCv(const QuietOpenCv&) = delete;
  QuietOpenCv& operator=(const QuietOpenCv&) = delete;

 private:
  cv::utils::logging::LogLevel before_;
};

/// Decodes in order; keeps the last frames, since threads ask for neighbours in any order.
class VideoFile : public FrameSource {
 public:
  explicit VideoFile(const std::filesystem::path& path) : path_(path) {
    open();
    // The container's own count is often wrong. Taken apart without decoding, its packets are
    // counted a hundred times faster; a library that cannot do that decodes them.
    video_.set(cv::CAP_PROP_FORMAT, -1);
    while (video_.grab()) ++size_;
    require(size_ > 0, "'", path_.string(), "' holds no video frame that can be decoded");
    open();
  }

  std::size_t size() const override { return size_; }

  Image8 read(std::size_t i) const override {
    const std::lock_guard lock(mutex_);
    if (i < next_ - std::min(next_, kept_.size())) open();
    while (next_ <= i) decode_next();
    return kept_[kept_.size() - (next_ - i)];
  }

 private:
  void open() const {
    const QuietOpenCv quiet;
    require(video_.open(path_.string()), "'", path_.string(), "' cannot be opened as a video");
    next_ = 0;
    kept_.clear();
  }

  void decode_next() const {
    cv::Mat frame;
    require(video_.read(frame), "frame ", next_, " of '", path_.string(), "' cannot be decoded");
    kept_.push_back(image_from(frame));
    if (kept_.size() > kKept) kept_.pop_front();
    ++next_;
  }

  static constexpr std::size_t kKept = 32;
  std::filesystem::path path_;
  std::size_t size_ = 0;
  mutable std::mutex mutex_;
  mutable cv::VideoCapture video_;
  mutable std::size_t next_ = 0;
  mutable std::deque<Image8> kept_;
};

}  // namespace

std::unique_ptr<FrameSource> open_frames(const std::vector<std::filesystem::path>& files) {
  require(!files.empty(), "expected at least one frame, got none");
  if (files.size() == 1 && is_video(files[0])) return std::make_unique<VideoFile>(files[0]);
  return std::make_unique<ImageFiles>(files);
}

Image8 read_image(const std::filesystem::path& path) {
  const Bytes bytes = read_bytes(path);
  require(!bytes.empty(), "frame '", path.string(), "' is an empty file");
  require(!is_torn(bytes), "frame '", path.string(), "' is cut short: the image has no end");
  cv::Mat mat;
  try {
    mat = cv::imdecode(bytes, cv::IMREAD_ANYCOLOR | cv::IMREAD_IGNORE_ORIENTATION);
  } catch (const cv::Exception&) {
    mat.release();
  }
  require(!mat.empty(), "frame '", path.string(), "' is not an image that can be decoded");
  return image_from(mat);
}

void write_image(const std::filesystem::path& path, ImageView8 image) {
  require(!image.empty(), "cannot write an empty image to '", path.string(), "'");
  const cv::Mat mat(image.rows,
                    image.cols,
                    CV_8UC(image.channels),
                    const_cast<std::uint8_t*>(image.data),
                    static_cast<std::size_t>(image.stride));
  Bytes bytes;
  bool encoded = false;
  try {
    encoded = cv::imencode(path.extension().string(), mat, bytes, {cv::IMWRITE_PNG_COMPRESSION, 1});
  } catch (const cv::Exception&) {
    encoded = false;
  }
  require(encoded, "cannot write '", path.string(), "' as an image; use .png or .jpg");
  AtomicFile file(path);
  file.stream().write(reinterpret_cast<const char*>(bytes.data()),
                      static_cast<std::streamsize>(bytes.size()));
  file.commit();
}

}  // namespace facula
