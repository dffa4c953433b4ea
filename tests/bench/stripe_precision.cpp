// SPDX-License-Identifier: GPL-3.0-or-later
//
// stripe_precision [--trials N] [--json | --markdown]: RMS position error and reduced chi2 of every
// stripe detector beside the Cramér-Rao bound, on lines drawn by formula. Seeds are fixed.
#include <facula/tests/bench/stripe_cases.hpp>

#include <charconv>
#include <cstdio>
#include <cstring>

namespace facula {
namespace {

enum class Form { kText, kMarkdown, kJson };

struct Request {
  int trials = 20000;
  Form form = Form::kText;
};

bool parse(int argc, char** argv, Request& request) {
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--json") == 0) {
      request.form = Form::kJson;
    } else if (std::strcmp(argv[i], "--markdown") == 0) {
      request.form = Form::kMarkdown;
    } else if (std::strcmp(argv[i], "--trials") == 0 && i + 1 < argc) {
      const char* text = argv[++i];
      const char* end = text + std::strlen(text);
      if (std::from_chars(text, end, request.trials).ptr != end || request.trials < 1) return false;
    } else {
      return false;
    }
  }
  return true;
}

struct Row {
  PrecisionCase which;
  PrecisionResult result;
};

/// What a table shows of one detector in one case.
using Cell = std::string (*)(const PositionErrors&);

std::string printed(const char* format, double value) {
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string rms_cell(const PositionErrors& e) {
  if (e.seen == 0) return "-";
  const std::string text = printed(e.rms() < 0.0995 ? "%.4f" : "%.3f", e.rms());
  const double seen = 100 * e.share_seen();
  return seen > 99.5 ? text : text + printed(" (%.0f %%)", seen);
}

std::string chi2_cell(const PositionErrors& e) {
  return e.seen == 0 ? "-" : printed(e.chi2() < 9.95 ? "%.2f" : "%.0f", e.chi2());
}

std::string worst_cell(const PositionErrors& e) {
  return e.seen == 0 ? "-" : printed("%.2f", e.worst);
}

void print_table(const std::vector<Row>& rows, const char* table, const char* title, Cell cell) {
  std::printf("\n%s\n\n| line | bound |", title);
  for (const std::string& name : detector_names()) std::printf(" %s |", name.c_str());
  std::printf("\n|---|---|");
  for (std::size_t i = 0; i < detector_names().size(); ++i) std::printf("---|");
  std::printf("\n");
  for (const Row& row : rows) {
    if (row.which.table != table) continue;
    std::printf("| %s | %.4f |", row.which.name.c_str(), row.result.bound.unknown);
    for (const PositionErrors& e : row.result.errors) std::printf(" %s |", cell(e).c_str());
    std::printf("\n");
  }
}

void print_markdown(const std::vector<Row>& rows) {
  print_table(rows, "grid", "RMS error [px] (rows seen, where not all)", rms_cell);
  print_table(rows, "grid", "Reduced chi2 [1]", chi2_cell);
  print_table(rows, "special", "RMS error [px], special cases", rms_cell);
  print_table(rows, "special", "Worst error [px], special cases", worst_cell);
  print_table(rows, "special", "Reduced chi2 [1], special cases", chi2_cell);
}

void print_text(const Row& row) {
  std::printf("%s: bound %.4f px (shape known %.4f)\n",
              row.which.name.c_str(),
              row.result.bound.unknown,
              row.result.bound.known_shape);
  for (std::size_t d = 0; d < row.result.errors.size(); ++d) {
    const PositionErrors& e = row.result.errors[d];
    std::printf(
        "  %-20s rms %.4f px (%.2f bound)  bias %+.4f  worst %.3f  chi2 %.3f  seen %.1f %%\n",
        detector_names()[d].c_str(),
        e.rms(),
        e.rms() / row.result.bound.unknown,
        e.bias(),
        e.worst,
        e.chi2(),
        100 * e.share_seen());
  }
  std::fflush(stdout);
}

void print_json(const std::vector<Row>& rows, int trials) {
  std::printf("{\"trials\": %d, \"cases\": [", trials);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& row = rows[i];
    std::printf("%s\n{\"name\": \"%s\", \"bound_px\": %.6g, \"bound_known_shape_px\": %.6g",
                i > 0 ? "," : "",
                row.which.name.c_str(),
                row.result.bound.unknown,
                row.result.bound.known_shape);
    for (std::size_t d = 0; d < row.result.errors.size(); ++d) {
      const PositionErrors& e = row.result.errors[d];
      std::printf(
          ",\n \"%s\": {\"rms_px\": %.6g, \"bias_px\": %.6g, \"worst_px\": %.6g, "
          "\"chi2\": %.6g, \"seen\": %.6g}",
          detector_names()[d].c_str(),
          e.rms(),
          e.bias(),
          e.worst,
          e.chi2(),
          e.share_seen());
    }
    std::printf("}");
  }
  std::printf("\n]}\n");
}

int run(const Request& request) {
  std::vector<Row> rows;
  for (const PrecisionCase& which : precision_cases()) {
    rows.push_back({which, measure_case(which, request.trials)});
    if (request.form == Form::kText) print_text(rows.back());
  }
  if (request.form == Form::kJson) print_json(rows, request.trials);
  if (request.form == Form::kMarkdown) print_markdown(rows);
  return 0;
}

}  // namespace
}  // namespace facula

int main(int argc, char** argv) {
  facula::Request request;
  if (!facula::parse(argc, argv, request)) {
    std::fprintf(stderr, "usage: stripe_precision [--trials N] [--json | --markdown]\n");
    return 1;
  }
  return facula::run(request);
}
