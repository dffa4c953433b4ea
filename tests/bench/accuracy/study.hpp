// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace facula {

/// A table of a study; every row has as many cells as there are columns.
struct StudyTable {
  std::string caption;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
};

/// Something that was asked for, with the number that decides it.
struct Verdict {
  std::string claim;     ///< "GREEN: mean error after compensation no worse than the paper's"
  std::string measured;  ///< the number that decides, with its unit
  bool reached = false;
};

/// What one source claims and what the heads of this project do.
struct Study {
  std::string title;
  std::vector<std::string> paragraphs;  ///< how it was done, before the tables
  std::vector<StudyTable> tables;
  std::vector<Verdict> verdicts;
};

/// Markdown of a study: heading, paragraphs, tables, verdicts.
std::string markdown(const Study& study);

/// A number with so many decimals.
std::string decimals(double value, int count);

}  // namespace facula
