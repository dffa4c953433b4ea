// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/atomic_file.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/apps/cli/deliver.hpp>

#include <iostream>

namespace facula {

void print(const std::string& text) {
  std::cout << text << std::flush;
  require(static_cast<bool>(std::cout),
          "expected standard output to take the results, got a write error; is the disk full?");
}

void deliver(const Figures& figures, const std::filesystem::path& json) {
  if (json == "-") {
    print(figures.json());
    return;
  }
  if (!json.empty()) {
    AtomicFile file(json);
    file.stream() << figures.json();
    file.commit();
  }
  print(figures.text());
}

}  // namespace facula
