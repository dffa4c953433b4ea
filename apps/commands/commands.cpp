// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/commands/commands.hpp>
#include <facula/apps/commands/demo.hpp>
#include <facula/apps/commands/extract.hpp>
#include <facula/apps/commands/info.hpp>
#include <facula/apps/commands/map.hpp>
#include <facula/apps/commands/measure_planes.hpp>
#include <facula/apps/commands/mesh.hpp>
#include <facula/apps/commands/register.hpp>
#include <facula/apps/commands/report.hpp>
#include <facula/apps/commands/simulate.hpp>

namespace facula {

std::vector<Command> all_commands() {
  return {simulate_command(),
          extract_command(),
          register_command(),
          mesh_command(),
          measure_planes_command(),
          map_command(),
          info_command(),
          report_command(),
          demo_command()};
}

}  // namespace facula
