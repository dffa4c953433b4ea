// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/atomic_file.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/map/grid_pixels.hpp>
#include <facula/map/map_yaml.hpp>
#include <facula/map/navigation_grid.hpp>

#include <locale>

namespace facula {
namespace {

void check_size(const NavigationGrid& grid, const GridFileOptions& options) {
  require(grid.rows > 0 && grid.cols > 0 && grid.cells.size() == grid.size(),
          "NavigationGrid: expected ",
          grid.rows,
          " x ",
          grid.cols,
          " cells, got ",
          grid.cells.size());
  require(options.mode == GridMode::kTrinary || grid.occupancy.size() == grid.size(),
          "NavigationGrid: expected ",
          grid.size(),
          " probabilities to write in mode ",
          to_string(options.mode),
          ", got ",
          grid.occupancy.size());
}

/// The keys of ROS map_server and nav2_map_server.
void write_yaml(std::ostream& out,
                const NavigationGrid& grid,
                const GridFileOptions& options,
                const std::string& image) {
  out.imbue(std::locale::classic());
  out << "image: " << yaml_scalar(image) << "\nmode: " << to_string(options.mode)
      << "\nresolution: " << exact_text(grid.resolution) << "\norigin: ["
      << exact_text(grid.origin.x()) << ", " << exact_text(grid.origin.y())
      << ", 0]\nnegate: " << (options.negate ? 1 : 0)
      << "\noccupied_thresh: " << exact_text(options.occupied_thresh())
      << "\nfree_thresh: " << exact_text(options.free_thresh()) << '\n';
}

GridRule rule_of(const MapYaml& yaml) {
  GridRule rule;
  if (yaml.entries.contains("mode")) rule.mode = grid_mode(yaml_text(yaml.text("mode")));
  rule.negate = yaml.truth("negate");
  rule.occupied_thresh = yaml.number("occupied_thresh");
  rule.free_thresh = yaml.number("free_thresh");
  require(rule.occupied_thresh > rule.free_thresh,
          "'",
          yaml.name,
          "': expected occupied_thresh above free_thresh, got ",
          rule.occupied_thresh,
          " and ",
          rule.free_thresh);
  return rule;
}

}  // namespace

void write_navigation_grid(const std::filesystem::path& yaml_path,
                           const NavigationGrid& grid,
                           const GridFileOptions& options) {
  const std::string extension = yaml_path.extension().string();
  require(extension == ".yaml" || extension == ".yml",
          "cannot write the grid '",
          yaml_path.string(),
          "': expected a name ending in .yaml");
  options.check();
  check_size(grid, options);
  const bool with_alpha = options.mode == GridMode::kScale;
  const auto image_path =
      std::filesystem::path(yaml_path).replace_extension(with_alpha ? ".png" : ".pgm");
  AtomicFile image(image_path);
  AtomicFile yaml(yaml_path);
  (with_alpha ? write_png : write_pgm)(image.stream(), image_of(grid, options));
  write_yaml(yaml.stream(), grid, options, image_path.filename().string());
  image.commit();
  yaml.commit();  // last: a YAML file always finds its image
}

NavigationGrid read_navigation_grid(const std::filesystem::path& yaml_path) {
  const MapYaml yaml = read_map_yaml(yaml_path);
  NavigationGrid grid;
  grid.resolution = yaml.number("resolution");
  require(grid.resolution > 0, "'", yaml.name, "': expected a resolution above 0 m");
  const auto origin = yaml.numbers("origin", 3);
  require(origin[2] == 0, "'", yaml.name, "': turned maps (yaw ", origin[2], ") are not read");
  grid.origin = {origin[0], origin[1]};
  const GridImage image = read_grid_image(yaml_path.parent_path() / yaml_text(yaml.text("image")));
  grid.rows = image.rows;
  grid.cols = image.cols;
  read_pixels(image, rule_of(yaml), grid);
  return grid;
}

}  // namespace facula
