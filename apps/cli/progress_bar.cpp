// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/cli/number_text.hpp>
#include <facula/apps/cli/progress_bar.hpp>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <utility>

#include <unistd.h>

namespace facula {
namespace {

std::string duration(double seconds) {
  const auto whole = std::llround(std::max(0.0, seconds));
  if (whole < 60) return std::to_string(whole) + " s";
  const std::string rest = std::to_string(whole % 60);
  return std::to_string(whole / 60) + " min " + (rest.size() < 2 ? "0" : "") + rest + " s";
}

}  // namespace

std::string ProgressBar::line(const std::string& what,
                              std::size_t done,
                              std::size_t total,
                              double elapsed) {
  if (total == 0) return what + "  " + duration(elapsed);
  constexpr int kWidth = 24;
  const double share = std::min(1.0, static_cast<double>(done) / static_cast<double>(total));
  const int filled = static_cast<int>(share * kWidth);
  std::string text = what + " [" + std::string(static_cast<std::size_t>(filled), '#') +
                     std::string(static_cast<std::size_t>(kWidth - filled), '.') + "] " +
                     fixed_text(100 * share, 0) + " %";
  if (share > 0) text += "  ETA " + duration(elapsed * (1 - share) / share);
  return text;
}

ProgressBar::ProgressBar(std::string what)
    : what_(std::move(what)), start_(std::chrono::steady_clock::now()) {
  if (isatty(STDERR_FILENO) != 0) painter_ = std::thread([this] { redraw_until_stopped(); });
}

ProgressBar::~ProgressBar() {
  if (!painter_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  stop_.notify_all();
  painter_.join();
  if (drawn_) std::cerr << "\r\033[K" << std::flush;
}

void ProgressBar::update(std::size_t done, std::size_t total) {
  const std::lock_guard lock(mutex_);
  done_ = done;
  total_ = total;
}

void ProgressBar::rename(const std::string& what) {
  const std::lock_guard lock(mutex_);
  what_ = what;
}

void ProgressBar::redraw_until_stopped() {
  using std::chrono::milliseconds;
  std::unique_lock lock(mutex_);
  milliseconds wait(1000);
  while (!stop_.wait_for(lock, wait, [this] { return stopping_; })) {
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
    std::cerr << "\r\033[K" << line(what_, done_, total_, elapsed.count()) << std::flush;
    drawn_ = true;
    wait = milliseconds(100);
  }
}

}  // namespace facula
