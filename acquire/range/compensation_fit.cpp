// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/range/compensation_fit.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include <Eigen/QR>

namespace facula {
namespace {

/// The parabola through the positions seen within `reach` lines of `line`, at `line`; none when
/// fewer than three were seen.
double smoothed_at(const std::vector<double>& positions, int line, int reach) {
  const int first = std::max(0, line - reach);
  const int last = std::min(static_cast<int>(positions.size()) - 1, line + reach);
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  int seen = 0;
  for (int u = first; u <= last; ++u) {
    const double value = positions[static_cast<std::size_t>(u)];
    if (!std::isfinite(value)) continue;
    const double x = static_cast<double>(u - line) / std::max(1, reach);
    const Eigen::Vector3d row(1, x, x * x);
    normal += row * row.transpose();
    right += row * value;
    ++seen;
  }
  if (seen < 3) return std::nan("");
  return normal.colPivHouseholderQr().solve(right)[0];
}

/// Lines not seen: on the straight line between their neighbours, as the nearest at the ends.
std::size_t fill_gaps(std::vector<double>& positions) {
  std::size_t filled = 0;
  std::ptrdiff_t before = -1;
  const auto size = static_cast<std::ptrdiff_t>(positions.size());
  const auto at = [&](std::ptrdiff_t u) -> double& {
    return positions[static_cast<std::size_t>(u)];
  };
  for (std::ptrdiff_t u = 0; u <= size; ++u) {
    if (u < size && !std::isfinite(at(u))) continue;
    for (std::ptrdiff_t g = before + 1; g < u; ++g) {
      ++filled;
      if (before < 0) {
        at(g) = at(u);
      } else if (u == size) {
        at(g) = at(before);
      } else {
        const double t = static_cast<double>(g - before) / static_cast<double>(u - before);
        at(g) = (1 - t) * at(before) + t * at(u);
      }
    }
    before = u;
  }
  return filled;
}

struct SmoothedPlane {
  CompensationTable::Plane plane;
  CompensationPlane figures;
  std::vector<double> measured;  ///< as given
};

double middle_position(const std::vector<double>& positions, int lines, const std::string& name) {
  const int middle = static_cast<int>(positions.size()) / 2;
  double sum = 0;
  int seen = 0;
  for (int u = middle - lines / 2; u <= middle + lines / 2; ++u) {
    const auto index = static_cast<std::size_t>(u);
    if (u < 0 || index >= positions.size() || !std::isfinite(positions[index])) continue;
    sum += positions[index];
    ++seen;
  }
  require(
      seen > 0,
      "plane '",
      name,
      "': the line was not seen in the middle of the picture, which the other lines are brought "
      "to; raise middle_lines or scan it again");
  return sum / seen;
}

SmoothedPlane smooth(const PlaneView& view, const CompensationOptions& options) {
  SmoothedPlane result;
  result.measured = view.positions;
  result.figures.name = view.name;
  const int lines = static_cast<int>(view.positions.size());
  double squares = 0;
  std::vector<double> smooth_line = view.positions;
  for (int u = 0; u < lines; ++u) {
    const double value = view.positions[static_cast<std::size_t>(u)];
    if (!std::isfinite(value)) continue;
    ++result.figures.seen;
    if (options.smooth == 0) continue;
    const double near = smoothed_at(view.positions, u, options.smooth);
    if (!std::isfinite(near)) continue;
    smooth_line[static_cast<std::size_t>(u)] = near;
    squares += (value - near) * (value - near);
  }
  require(result.figures.seen * 4 >= view.positions.size(),
          "plane '",
          view.name,
          "': the line was seen in ",
          result.figures.seen,
          " of ",
          view.positions.size(),
          " lines, a quarter is the least; scan a larger wall, or with more light");
  result.figures.scatter = std::sqrt(squares / static_cast<double>(result.figures.seen));
  result.plane.position = middle_position(smooth_line, options.middle_lines, view.name);
  result.figures.position = result.plane.position;
  for (const double value : smooth_line) {
    if (!std::isfinite(value)) continue;
    result.figures.largest_shift =
        std::max(result.figures.largest_shift, std::abs(result.plane.position - value));
  }
  result.figures.filled = fill_gaps(smooth_line);
  result.plane.measured = std::move(smooth_line);
  return result;
}

std::vector<CompensationTable::Plane> table_planes(const std::vector<SmoothedPlane>& planes,
                                                   std::size_t without) {
  std::vector<CompensationTable::Plane> result;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    if (i != without) result.push_back(planes[i].plane);
  }
  return result;
}

/// Each inner plane against the table of the others: what stays between two distances of the table.
void hold_out(std::vector<SmoothedPlane>& planes, const CompensationOptions& options) {
  for (std::size_t i = 0; i < planes.size(); ++i) {
    SmoothedPlane& plane = planes[i];
    const bool inner = i > 0 && i + 1 < planes.size();
    const CompensationTable others(table_planes(planes, i), options.window);
    double after = 0;
    double before = 0;
    for (std::size_t u = 0; u < plane.measured.size(); ++u) {
      const double z = plane.measured[u];
      if (!std::isfinite(z)) continue;
      const double left = others.corrected(static_cast<int>(u), z) - plane.plane.position;
      after += left * left;
      before += (z - plane.plane.position) * (z - plane.plane.position);
    }
    const auto seen = static_cast<double>(plane.figures.seen);
    plane.figures.held_out_rms = inner ? std::sqrt(after / seen) : std::nan("");
    plane.figures.uncorrected_rms = std::sqrt(before / seen);
  }
}

template <typename... Parts>
std::string sentence(const Parts&... parts) {
  std::ostringstream text;
  (text << ... << parts);
  return text.str();
}

std::vector<std::string> warnings_of(const std::vector<SmoothedPlane>& planes) {
  std::vector<std::string> warnings;
  for (const SmoothedPlane& p : planes) {
    const CompensationPlane& f = p.figures;
    if (10 * f.filled > p.measured.size()) {
      warnings.push_back(sentence("plane '",
                                  f.name,
                                  "': ",
                                  f.filled,
                                  " of ",
                                  p.measured.size(),
                                  " lines were not seen and stand as their neighbours; a larger "
                                  "wall corrects them too"));
    }
    if (f.scatter > 0.5) {
      warnings.push_back(sentence("plane '",
                                  f.name,
                                  "': positions scatter by ",
                                  f.scatter,
                                  " px about a smooth line; average more frames, or the wall is "
                                  "not flat"));
    }
    if (f.held_out_rms > f.uncorrected_rms && f.held_out_rms > 2 * f.scatter) {
      warnings.push_back(sentence("plane '",
                                  f.name,
                                  "': its neighbours correct it worse (",
                                  f.held_out_rms,
                                  " px) than no table (",
                                  f.uncorrected_rms,
                                  " px): scan walls between them"));
    }
  }
  return warnings;
}

}  // namespace

void CompensationOptions::check() const {
  require(window >= 0 && window <= 1000, "expected a window of 0 to 1000 lines, got ", window);
  require(middle_lines >= 1 && middle_lines <= 1000,
          "expected 1 to 1000 middle lines, got ",
          middle_lines);
  require(smooth == 0 || (smooth >= 2 && smooth <= 1000),
          "expected to smooth over 0, or 2 to 1000 lines to both sides, got ",
          smooth);
}

CompensationFit fit_compensation(const std::vector<PlaneView>& views,
                                 const CompensationOptions& options) {
  options.check();
  require(views.size() >= 2,
          "expected at least two walls at different distances, got ",
          views.size(),
          "; source B uses ten");
  std::vector<SmoothedPlane> planes;
  for (const PlaneView& view : views) {
    require(view.positions.size() == views.front().positions.size() && !view.positions.empty(),
            "plane '",
            view.name,
            "': expected ",
            views.front().positions.size(),
            " lines as in plane '",
            views.front().name,
            "', got ",
            view.positions.size());
    planes.push_back(smooth(view, options));
  }
  std::sort(planes.begin(), planes.end(), [](const SmoothedPlane& a, const SmoothedPlane& b) {
    return a.plane.position < b.plane.position;
  });
  CompensationFit fit{
      CompensationTable(table_planes(planes, planes.size()), options.window), {}, {}};
  hold_out(planes, options);
  for (const SmoothedPlane& p : planes) fit.planes.push_back(p.figures);
  fit.warnings = warnings_of(planes);
  return fit;
}

}  // namespace facula
