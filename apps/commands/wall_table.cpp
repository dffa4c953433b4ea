// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/capture/frame_source.hpp>
#include <facula/acquire/core/csv_table.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/stripe/stripe_detector.hpp>
#include <facula/apps/commands/wall_table.hpp>

#include <cmath>
#include <map>

namespace facula {
namespace {

/// Sums of the positions per line at one distance.
struct Sums {
  std::vector<double> sum;
  std::vector<double> count;

  explicit Sums(int lines)
      : sum(static_cast<std::size_t>(lines)), count(static_cast<std::size_t>(lines)) {}

  void add(std::size_t line, double position) {
    sum[line] += position;
    count[line] += 1;
  }
};

using SumsByDistance = std::map<double, Sums>;

int lines_of(const Rig& rig) {
  return rig.stripe_direction == StripeDirection::kPerRow ? rig.camera.height : rig.camera.width;
}

void add_frames(const CsvTable& csv,
                const std::filesystem::path& folder,
                const Rig& rig,
                const WallStripe& wall_stripe,
                SumsByDistance& walls) {
  StripeOptions stripe;
  stripe.channel = channel_from_name(wall_stripe.channel);
  stripe.sigma = wall_stripe.sigma;
  stripe.direction = rig.stripe_direction;
  stripe.check();
  const std::vector<double> distances = csv.column(kDistanceColumns);
  const std::vector<std::string> frames = csv.texts("frame");
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Image8 frame = read_image(folder / frames[i]);
    require(frame.cols == rig.camera.width && frame.rows == rig.camera.height,
            "frame '",
            frames[i],
            "': expected ",
            rig.camera.width,
            " x ",
            rig.camera.height,
            " px as the rig's camera says, got ",
            frame.cols,
            " x ",
            frame.rows);
    const StripeProfile profile = detect_stripe(frame.view(), {}, stripe);
    Sums& sums = walls.try_emplace(distances[i], lines_of(rig)).first->second;
    for (std::size_t u = 0; u < profile.size(); ++u) {
      if (profile.seen[u] != 0) sums.add(u, static_cast<double>(profile.position[u]));
    }
  }
}

void add_lines(const CsvTable& csv, const Rig& rig, SumsByDistance& walls) {
  const std::vector<double> distances = csv.column(kDistanceColumns);
  const std::vector<double> lines = csv.column({"line"});
  const std::vector<double> positions = csv.column(kPositionColumns);
  for (std::size_t i = 0; i < distances.size(); ++i) {
    require(lines[i] >= 0 && lines[i] < lines_of(rig) && lines[i] == std::floor(lines[i]),
            "expected lines of 0 to ",
            lines_of(rig) - 1,
            ", as the rig's picture has, got ",
            lines[i]);
    walls.try_emplace(distances[i], lines_of(rig))
        .first->second.add(static_cast<std::size_t>(lines[i]), positions[i]);
  }
}

/// Lagrange's parabola through the first, middle and last line.
void add_three_points(const CsvTable& csv, const Rig& rig, SumsByDistance& walls) {
  const std::vector<double> distances = csv.column(kDistanceColumns);
  const std::vector<double> top = csv.column({"top_px"});
  const std::vector<double> centre = csv.column({"centre_px"});
  const std::vector<double> bottom = csv.column({"bottom_px"});
  const int lines = lines_of(rig);
  for (std::size_t i = 0; i < distances.size(); ++i) {
    Sums& sums = walls.try_emplace(distances[i], lines).first->second;
    for (int u = 0; u < lines; ++u) {
      const double t = 2.0 * u / (lines - 1) - 1;
      sums.add(
          static_cast<std::size_t>(u),
          0.5 * t * (t - 1) * top[i] + (1 - t * t) * centre[i] + 0.5 * t * (t + 1) * bottom[i]);
    }
  }
}

}  // namespace

void declare_wall_stripe(Arguments& arguments, WallStripe& stripe) {
  arguments.choice(
      "--channel",
      stripe.channel,
      {"grey", "red", "green", "blue", "red-excess", "green-excess", "blue-excess", "maximum"},
      "of frames: what of a colour pixel counts");
  arguments.number("--sigma-px", stripe.sigma, kPixels, "of frames: width of the line, 1 sigma");
}

std::vector<Wall> read_walls(const std::filesystem::path& table,
                             const Rig& rig,
                             const WallStripe& stripe) {
  const CsvTable csv = CsvTable::from_file(table);
  SumsByDistance sums;
  if (csv.has("frame")) {
    add_frames(csv, table.parent_path(), rig, stripe, sums);
  } else if (csv.has("line")) {
    add_lines(csv, rig, sums);
  } else {
    require(csv.has("top_px") && csv.has("centre_px") && csv.has("bottom_px"),
            table.string(),
            ": expected walls in the columns frame, or line and position_px, or top_px, centre_px "
            "and bottom_px");
    add_three_points(csv, rig, sums);
  }
  std::vector<Wall> walls;
  for (const auto& [distance, s] : sums) {
    Wall wall{distance, std::vector<double>(s.sum.size(), std::nan(""))};
    for (std::size_t u = 0; u < s.sum.size(); ++u) {
      if (s.count[u] > 0) wall.positions[u] = s.sum[u] / s.count[u];
    }
    walls.push_back(std::move(wall));
  }
  return walls;
}

double middle_position(const Wall& wall, int lines) {
  const int middle = static_cast<int>(wall.positions.size()) / 2;
  double sum = 0;
  int seen = 0;
  for (int u = middle - lines / 2; u <= middle + lines / 2; ++u) {
    const auto index = static_cast<std::size_t>(u);
    if (u < 0 || index >= wall.positions.size() || !std::isfinite(wall.positions[index])) continue;
    sum += wall.positions[index];
    ++seen;
  }
  return seen == 0 ? std::nan("") : sum / seen;
}

}  // namespace facula
