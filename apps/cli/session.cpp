// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/cli/log.hpp>
#include <facula/apps/cli/session.hpp>

namespace facula {

Progress Session::progress(const std::string& what) const {
  log_step(what);
  const auto bar = std::make_shared<ProgressBar>(what);
  return [bar](std::size_t done, std::size_t total) { bar->update(done, total); };
}

void Session::step(const std::string& what, std::size_t number, std::size_t count) {
  log_step(what);
  if (!steps_) steps_ = std::make_unique<ProgressBar>(what);
  steps_->rename(what);
  steps_->update(number - 1, count);
}

void Session::end_steps() {
  steps_.reset();
}

}  // namespace facula
