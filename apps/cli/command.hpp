// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/arguments.hpp>
#include <facula/apps/cli/session.hpp>

#include <functional>
#include <string>
#include <vector>

namespace facula {

/// A command of the program.
struct Command {
  std::string name;                   ///< "extract", "measure planes"
  std::string summary;                ///< half a line for the list of commands
  std::string description;            ///< a few sentences for --help
  std::vector<std::string> examples;  ///< runnable in this order in an empty folder
  std::function<void(Arguments&)> declare;
  std::function<void(Session&)> run;  ///< throws Error
  std::string group = {};             ///< heading in the list of commands
};

}  // namespace facula
