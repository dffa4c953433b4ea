// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/calibrate/calibration_set_file.hpp>
#include <facula/acquire/core/atomic_file.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/toml_text.hpp>

#include <locale>
#include <numbers>

namespace facula {
namespace {

std::ostream& prepared(AtomicFile& file) {
  std::ostream& out = file.stream();
  out.imbue(std::locale::classic());
  out.precision(12);
  return out;
}

using Views = std::vector<const JointView*>;

void write_corners(const std::filesystem::path& path, const Views& views) {
  AtomicFile file(path);
  std::ostream& out = prepared(file);
  out << "view,point,x_px,y_px\n";
  for (const JointView* view : views) {
    for (std::size_t p = 0; p < view->points.ids.size(); ++p) {
      out << view->points.name << ',' << view->points.ids[p] << ',' << view->points.pixels[p].x()
          << ',' << view->points.pixels[p].y() << '\n';
    }
  }
  file.commit();
}

bool any_lines(const Views& views) {
  for (const JointView* view : views) {
    if (!view->lines.empty()) return true;
  }
  return false;
}

void write_lines(const std::filesystem::path& path, const CalibrationSet& set, const Views& views) {
  AtomicFile file(path);
  std::ostream& out = prepared(file);
  out << "view,laser,x_px,y_px,sigma_px\n";
  for (const JointView* view : views) {
    for (const LaserLineView& line : view->lines) {
      for (std::size_t p = 0; p < line.pixels.size(); ++p) {
        out << view->points.name << ',' << set.lasers[line.laser] << ',' << line.pixels[p].x()
            << ',' << line.pixels[p].y() << ',' << line.sigmas[p] << '\n';
      }
    }
  }
  file.commit();
}

void write_positions(const std::filesystem::path& path, AxisKind axis, const Views& views) {
  AtomicFile file(path);
  std::ostream& out = prepared(file);
  const bool linear = axis == AxisKind::kLinear;
  out << (linear ? "position_mm" : "position_deg") << ",placement\n";
  for (const JointView* view : views) {
    const double position = view->position.value_or(0);
    out << (linear ? 1000 * position : position * 180 / std::numbers::pi) << ','
        << view->placement + 1 << '\n';
  }
  file.commit();
}

void write_group(const std::filesystem::path& folder,
                 const CalibrationSet& set,
                 const std::string& name,
                 const Views& views,
                 std::ostream& toml) {
  if (views.empty()) return;
  toml << "\n[[views]]\nboard = " << views.front()->board + 1 << "\ncorners = \"" << name
       << "_corners.csv\"\n";
  write_corners(folder / (name + "_corners.csv"), views);
  if (any_lines(views)) {
    toml << "lines = \"" << name << "_lines.csv\"\n";
    write_lines(folder / (name + "_lines.csv"), set, views);
  }
  if (views.front()->position) {
    toml << "positions = \"" << name << "_positions.csv\"\n";
    write_positions(folder / (name + "_positions.csv"), set.axis, views);
  }
}

void write_board(const Board& board, std::ostream& toml) {
  toml << "\n[[board]]\nkind = \"" << to_string(board.kind) << "\"\ncols = " << board.cols
       << "\nrows = " << board.rows << "\nspacing_mm = " << 1000 * board.spacing << "\n";
}

}  // namespace

void write_calibration_set(const std::filesystem::path& folder, const CalibrationSet& set) {
  require(!set.views.empty(), "expected a calibration set with views to write, got none");
  AtomicFile file(folder / "calibration.toml");
  std::ostream& toml = prepared(file);
  toml << "# What docs/calibration.md describes.\naxis = \"" << to_string(set.axis)
       << "\"\nstripe = \""
       << (set.stripe_direction == StripeDirection::kPerRow ? "upright" : "level")
       << "\"\nimage_width_px = " << set.views.front().points.image_width
       << "\nimage_height_px = " << set.views.front().points.image_height << "\nlasers = [";
  for (const std::string& laser : set.lasers) {
    toml << (&laser == set.lasers.data() ? "" : ", ") << toml_quoted(laser);
  }
  toml << "]\n";
  for (const Board& board : set.boards) write_board(board, toml);
  for (std::size_t b = 0; b < set.boards.size(); ++b) {
    Views by_hand;
    Views placed;
    for (const JointView& view : set.views) {
      if (view.board == b) (view.position ? placed : by_hand).push_back(&view);
    }
    const std::string number = set.boards.size() > 1 ? std::to_string(b + 1) : "";
    write_group(folder, set, "hand" + number, by_hand, toml);
    write_group(folder, set, "axis" + number, placed, toml);
  }
  file.commit();
}

}  // namespace facula
