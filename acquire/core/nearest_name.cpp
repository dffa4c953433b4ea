// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/nearest_name.hpp>

#include <algorithm>
#include <numeric>

namespace facula {
namespace {

/// Insertions, deletions and replacements that turn `a` into `b` (Levenshtein 1966), row by row.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
    }
  }
  return row[b.size()];
}

}  // namespace

std::string nearest_name(const std::string& word, const std::vector<std::string>& known) {
  std::string nearest;
  std::size_t smallest = std::string::npos;
  for (const std::string& name : known) {
    const std::size_t allowed = std::clamp<std::size_t>(name.size() / 3, 1, 3);
    const std::size_t distance = edit_distance(word, name);
    if (distance > allowed || distance >= smallest) continue;
    smallest = distance;
    nearest = name;
  }
  return nearest;
}

}  // namespace facula
