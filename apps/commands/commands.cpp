// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/commands/calibrate_board.hpp>
#include <facula/apps/commands/calibrate_camera.hpp>
#include <facula/apps/commands/calibrate_compensation.hpp>
#include <facula/apps/commands/calibrate_joint.hpp>
#include <facula/apps/commands/calibrate_laser.hpp>
#include <facula/apps/commands/calibrate_profile.hpp>
#include <facula/apps/commands/calibrate_range.hpp>
#include <facula/apps/commands/calibrate_two_line.hpp>
#include <facula/apps/commands/commands.hpp>
#include <facula/apps/commands/demo.hpp>
#include <facula/apps/commands/design.hpp>
#include <facula/apps/commands/extract.hpp>
#include <facula/apps/commands/filter.hpp>
#include <facula/apps/commands/info.hpp>
#include <facula/apps/commands/map.hpp>
#include <facula/apps/commands/map_diff.hpp>
#include <facula/apps/commands/map_merge.hpp>
#include <facula/apps/commands/map_plan.hpp>
#include <facula/apps/commands/map_query.hpp>
#include <facula/apps/commands/measure_angles.hpp>
#include <facula/apps/commands/measure_compare.hpp>
#include <facula/apps/commands/measure_distance.hpp>
#include <facula/apps/commands/measure_flatness.hpp>
#include <facula/apps/commands/measure_planes.hpp>
#include <facula/apps/commands/measure_profile.hpp>
#include <facula/apps/commands/measure_two_line.hpp>
#include <facula/apps/commands/mesh.hpp>
#include <facula/apps/commands/register.hpp>
#include <facula/apps/commands/report.hpp>
#include <facula/apps/commands/simulate.hpp>

#include <string>
#include <utility>

namespace facula {

std::vector<Command> all_commands() {
  std::vector<Command> commands;
  const auto add = [&commands](const std::string& group, std::vector<Command> more) {
    for (Command& command : more) {
      command.group = group;
      commands.push_back(std::move(command));
    }
  };
  add("From frames to maps",
      {simulate_command(),
       extract_command(),
       filter_command(),
       register_command(),
       mesh_command(),
       measure_planes_command(),
       measure_angles_command(),
       measure_distance_command(),
       measure_flatness_command(),
       measure_profile_command(),
       measure_compare_command(),
       measure_two_line_command(),
       map_command(),
       map_merge_command(),
       map_diff_command(),
       map_query_command(),
       map_plan_command()});
  add("A head with a board",
      {calibrate_camera_command(),
       calibrate_laser_command(),
       calibrate_axis_command(),
       calibrate_joint_command()});
  add("A head without a board",
      {calibrate_range_command(),
       calibrate_compensation_command(),
       calibrate_profile_command(),
       calibrate_two_line_command()});
  add("Before there is a head",
      {design_command(), calibrate_board_command(), calibrate_example_command()});
  add("Look at results", {info_command(), report_command(), demo_command()});
  return commands;
}

}  // namespace facula
