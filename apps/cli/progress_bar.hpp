// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <string>
#include <thread>

namespace facula {

/// A line on standard error: what is done, how much of it, and how long it will still take. Shown
/// only on a terminal and only once the work has taken a second; wiped when the bar goes.
class ProgressBar {
 public:
  explicit ProgressBar(std::string what);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// `done` of `total` steps are finished.
  void update(std::size_t done, std::size_t total);

  /// Names the step that runs now.
  void rename(const std::string& what);

  /// The line as it stands after `elapsed` [s].
  static std::string line(const std::string& what,
                          std::size_t done,
                          std::size_t total,
                          double elapsed);

 private:
  void redraw_until_stopped();

  std::string what_;
  std::size_t done_ = 0;
  std::size_t total_ = 0;
  bool stopping_ = false;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point start_;
  std::mutex mutex_;
  std::condition_variable stop_;
  std::thread painter_;  ///< only on a terminal
};

}  // namespace facula
