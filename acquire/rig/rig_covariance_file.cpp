// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/toml_text.hpp>
#include <facula/acquire/rig/rig_covariance_file.hpp>

#include <ostream>

namespace facula {

RigCovariance read_covariance(TomlTable table) {
  RigCovariance covariance;
  covariance.parameters = table.texts("parameters");
  const std::vector<std::vector<double>> rows = table.number_rows("rows");
  const std::size_t n = covariance.parameters.size();
  require(n > 0, table.where("parameters"), ": expected at least one name");
  require(rows.size() == n,
          table.where("rows"),
          ": expected ",
          n,
          " rows, one per parameter, got ",
          rows.size());
  covariance.matrix.resize(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n));
  for (std::size_t r = 0; r < n; ++r) {
    require(rows[r].size() == n,
            table.where("rows"),
            ": expected ",
            n,
            " numbers in row ",
            r + 1,
            ", got ",
            rows[r].size());
    for (std::size_t c = 0; c < n; ++c) {
      covariance.matrix(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) = rows[r][c];
    }
  }
  table.finish();
  return covariance;
}

void write_covariance(std::ostream& out, const RigCovariance& covariance) {
  out << "\n[covariance]  # of the calibration, in the units of the names\nparameters = [\n";
  for (const std::string& name : covariance.parameters) out << "  " << toml_quoted(name) << ",\n";
  out << "]\nrows = [\n";
  for (Eigen::Index r = 0; r < covariance.matrix.rows(); ++r) {
    out << "  [";
    for (Eigen::Index c = 0; c < covariance.matrix.cols(); ++c) {
      out << (c == 0 ? "" : ", ") << covariance.matrix(r, c);
    }
    out << "],\n";
  }
  out << "]\n";
}

}  // namespace facula
