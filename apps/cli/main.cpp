// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/cli/program.hpp>
#include <facula/apps/commands/commands.hpp>

#include <string>
#include <vector>

int main(int argc, char** argv) {
  return facula::run_program(std::vector<std::string>(argv + 1, argv + argc),
                             facula::all_commands());
}
