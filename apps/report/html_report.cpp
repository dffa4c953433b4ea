// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/atomic_file.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/version.hpp>
#include <facula/apps/report/base64.hpp>
#include <facula/apps/report/html_report.hpp>
#include <facula/apps/report/html_style.hpp>
#include <facula/apps/report/html_text.hpp>

#include <algorithm>
#include <array>
#include <ctime>

namespace facula {
namespace {

constexpr std::size_t kColumnsThatFit = 9;  // of a table, without smaller letters

/// Running numbers of figures and tables.
struct Numbers {
  int figure = 0;
  int table = 0;
};

std::string now_utc() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&now, &parts);
  std::array<char, 32> text{};
  const std::size_t length = std::strftime(text.data(), text.size(), "%Y-%m-%d %H:%M UTC", &parts);
  return {text.data(), length};
}

/// Which columns hold only figures (empty cells do not count, a column of them is text).
std::vector<bool> figure_columns(const ReportTable& table) {
  std::vector<bool> figures(table.columns.size(), false);
  for (std::size_t col = 0; col < table.columns.size(); ++col) {
    bool any = false;
    const bool all = std::all_of(table.rows.begin(), table.rows.end(), [&](const auto& row) {
      any = any || !row[col].empty();
      return row[col].empty() || is_figure(row[col]);
    });
    figures[col] = all && any;
  }
  return figures;
}

void check_table(const ReportTable& table) {
  for (const std::vector<std::string>& row : table.rows) {
    require(row.size() == table.columns.size(),
            "the table '",
            table.caption,
            "' has ",
            table.columns.size(),
            " columns but a row of ",
            row.size(),
            " cells");
  }
}

std::string caption_html(const std::string& kind, int number, const std::string& caption) {
  std::string html = "<b>" + kind + " " + std::to_string(number) + ".</b>";
  if (!caption.empty()) html += " " + html_escaped(caption);
  return html;
}

std::string row_html(const std::vector<std::string>& cells,
                     const std::vector<bool>& figures,
                     const std::string& tag) {
  std::string html = "<tr>";
  const std::string scope = tag == "th" ? " scope=\"col\"" : "";
  for (std::size_t col = 0; col < cells.size(); ++col) {
    html += '<';
    html += tag;
    html += scope;
    html += figures[col] ? " class=\"figure\">" : ">";
    html += html_escaped(cells[col]);
    html += "</";
    html += tag;
    html += '>';
  }
  return html + "</tr>\n";
}

std::string table_html(const ReportTable& table, Numbers& numbers) {
  check_table(table);
  const std::vector<bool> figures = figure_columns(table);
  const bool wide = table.columns.size() > kColumnsThatFit;
  std::string html =
      (wide ? "<div class=\"scroll wide\">" : "<div class=\"scroll\">") +
      std::string("\n<table>\n<caption>") + caption_html("Table", ++numbers.table, table.caption) +
      "</caption>\n<thead>\n" + row_html(table.columns, figures, "th") + "</thead>\n<tbody>\n";
  for (const std::vector<std::string>& row : table.rows) html += row_html(row, figures, "td");
  return html + "</tbody>\n</table>\n</div>\n";
}

std::string picture_html(const ReportPicture& picture, Numbers& numbers) {
  return "<figure>\n<img alt=\"" + html_escaped(picture.caption) +
         "\" src=\"data:image/png;base64," + base64(picture.png) + "\">\n<figcaption>" +
         caption_html("Figure", ++numbers.figure, picture.caption) + "</figcaption>\n</figure>\n";
}

std::string section_html(const ReportSection& section, std::size_t number, Numbers& numbers) {
  const std::string n = std::to_string(number);
  std::string html = "<section id=\"section-" + n + "\">\n<h2><span class=\"number\">" + n +
                     "</span>" + html_escaped(section.heading) + "</h2>\n";
  html += html_paragraphs(section.text);
  for (const ReportTable& table : section.tables) html += table_html(table, numbers);
  for (const ReportPicture& picture : section.pictures) html += picture_html(picture, numbers);
  return html + "</section>\n";
}

std::string head_html(const Report& report) {
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
         "<meta name=\"generator\" content=\"Facula " +
         html_escaped(version()) + "\">\n<title>" + html_escaped(report.title) +
         "</title>\n<style>" + kReportStyle + "</style>\n</head>\n";
}

std::string masthead_html(const Report& report, const std::string& date) {
  return "<header class=\"masthead\">\n<p class=\"mark\">Measurement report</p>\n<h1>" +
         html_escaped(report.title) + "</h1>\n<dl class=\"facts\">\n<div><dt>Date</dt><dd>" +
         html_escaped(date) + "</dd></div>\n<div><dt>Software</dt><dd>Facula " +
         html_escaped(version()) + "</dd></div>\n</dl>\n</header>\n";
}

std::string contents_html(const Report& report) {
  constexpr std::size_t kFewest = 4;  // shorter reports are seen at a glance
  if (report.sections.size() < kFewest) return "";
  std::string html = "<nav aria-label=\"Contents\">\n<ol>\n";
  for (std::size_t i = 0; i < report.sections.size(); ++i) {
    html += "<li><a href=\"#section-" + std::to_string(i + 1) + "\">" +
            html_escaped(report.sections[i].heading) + "</a></li>\n";
  }
  return html + "</ol>\n</nav>\n";
}

}  // namespace

std::string html_report(const Report& report) {
  const std::string date = report.date.empty() ? now_utc() : report.date;
  Numbers numbers;
  std::string html = head_html(report) + "<body>\n" + masthead_html(report, date) + "<main>\n";
  html += html_paragraphs(report.introduction);
  if (!report.summary.rows.empty()) {
    html += "<div class=\"summary\">\n" + table_html(report.summary, numbers) + "</div>\n";
  }
  html += contents_html(report);
  for (std::size_t i = 0; i < report.sections.size(); ++i) {
    html += section_html(report.sections[i], i + 1, numbers);
  }
  html += "</main>\n<footer class=\"imprint\">\n<p>Written by Facula " + html_escaped(version()) +
          " on " + html_escaped(date) +
          ". Lengths are in the units stated beside them; ± values and sigma are one standard "
          "deviation.</p>\n</footer>\n</body>\n</html>\n";
  return html;
}

void write_html_report(const std::filesystem::path& path, const Report& report) {
  const std::string html = html_report(report);
  AtomicFile file(path);
  file.stream().write(html.data(), static_cast<std::streamsize>(html.size()));
  file.commit();
}

}  // namespace facula
