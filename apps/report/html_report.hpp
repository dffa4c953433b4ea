// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace facula {

/// A picture with its caption.
struct ReportPicture {
  std::string caption;  ///< a sentence; also the text for those who cannot see the picture
  std::string png;      ///< bytes of a PNG file, from encode_png()
};

/// A table. Columns that hold only figures (with or without unit: "12.3", "-4 mm", "99 %") are set
/// flush right.
struct ReportTable {
  std::string caption;
  std::vector<std::string> columns;            ///< headings, units in brackets
  std::vector<std::vector<std::string>> rows;  ///< each as long as `columns`
};

struct ReportSection {
  std::string heading;
  std::string text;  ///< paragraphs, separated by an empty line
  std::vector<ReportPicture> pictures;
  std::vector<ReportTable> tables;
};

struct Report {
  std::string title;
  std::string introduction;  ///< paragraphs below the title; may be empty
  std::string date;          ///< "2026-01-31 12:00 UTC"; empty = now
  ReportTable summary;       ///< shown first; none when it has no rows
  std::vector<ReportSection> sections;
};

/// The report as one HTML page that needs nothing else: style and pictures are part of it. All text
/// is escaped. Throws Error when a table's row has another length than its columns.
std::string html_report(const Report& report);

/// Writes html_report() to a file, whole or not at all.
void write_html_report(const std::filesystem::path& path, const Report& report);

}  // namespace facula
