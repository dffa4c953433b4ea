// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/progress.hpp>
#include <facula/apps/cli/figures.hpp>
#include <facula/apps/cli/progress_bar.hpp>

#include <cstddef>
#include <memory>
#include <string>

namespace facula {

/// What a running command is given: how many threads, where its figures go, how to show progress.
class Session {
 public:
  int num_threads = 0;  ///< 0 = all cores [1]
  Figures figures;

  /// A progress bar for a loop of the library; it goes with the last copy of the function.
  Progress progress(const std::string& what) const;

  /// Begins step `number` of `count` of a command whose steps do not report by themselves.
  void step(const std::string& what, std::size_t number, std::size_t count);

  /// Takes the bar of step() away.
  void end_steps();

 private:
  std::unique_ptr<ProgressBar> steps_;
};

}  // namespace facula
