// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/version.hpp>
#include <facula/apps/report/base64.hpp>
#include <facula/apps/report/drawing.hpp>
#include <facula/apps/report/html_report.hpp>
#include <facula/apps/report/html_text.hpp>
#include <facula/apps/report/png.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <cctype>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace facula {
namespace {

std::string example_png() {
  return encode_png(make_canvas(3, 5, {10, 200, 30}));
}

Report example_report() {
  Report report;
  report.title = "Plate <A&B> \"7\"";
  report.introduction = "First paragraph.\n\nSecond 'paragraph' with x < y.";
  report.date = "2026-01-31 12:00 UTC";
  report.summary = {"At a glance", {"Quantity", "Value [mm]"}, {{"Flatness", "0.042"}}};
  for (int i = 0; i < 5; ++i) {
    ReportSection section{"Section & more", "Text.", {{"A <caption>", example_png()}}, {}};
    section.tables.push_back({"T", {"a", "b"}, {{"one", "-1.5"}, {"<two>", "12 mm"}}});
    report.sections.push_back(section);
  }
  return report;
}

/// The names of all tags in order: "p" opened, "/p" closed. Fails the test at a stray '<'.
std::vector<std::string> tags_of(const std::string& html) {
  std::vector<std::string> tags;
  for (std::size_t at = html.find('<'); at != std::string::npos; at = html.find('<', at + 1)) {
    const std::size_t end = html.find('>', at);
    if (end == std::string::npos) {
      ADD_FAILURE() << "'<' without '>' at " << at;
      break;
    }
    std::string name;
    for (std::size_t i = at + 1; i < end && std::isspace(static_cast<unsigned char>(html[i])) == 0;
         ++i) {
      name += html[i];
    }
    tags.push_back(name);
  }
  return tags;
}

/// Why the elements do not nest, or an empty text.
std::string nesting_fault(const std::string& html) {
  const std::set<std::string> empty_elements{"!DOCTYPE", "meta", "img"};
  std::vector<std::string> open;
  for (const std::string& tag : tags_of(html)) {
    if (empty_elements.count(tag) > 0) continue;
    if (tag[0] != '/') {
      open.push_back(tag);
    } else if (open.empty() || open.back() != tag.substr(1)) {
      return "<" + tag + "> closes " + (open.empty() ? "nothing" : "<" + open.back() + ">");
    } else {
      open.pop_back();
    }
  }
  return open.empty() ? "" : "<" + open.back() + "> stays open";
}

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++count;
  }
  return count;
}

TEST(HtmlReport, NestsItsElementsProperly) {
  EXPECT_EQ(nesting_fault(html_report(example_report())), "");
  EXPECT_EQ(nesting_fault(html_report(Report{})), "");
  // The check itself sees faults.
  EXPECT_NE(nesting_fault("<p><b></p></b>"), "");
  EXPECT_NE(nesting_fault("<p>"), "");
}

TEST(HtmlReport, NeedsNothingFromOutside) {
  const std::string html = html_report(example_report());
  EXPECT_EQ(html.find("http://"), std::string::npos);
  EXPECT_EQ(html.find("https://"), std::string::npos);
  EXPECT_EQ(html.find("url("), std::string::npos);
  EXPECT_EQ(html.find("@import"), std::string::npos);
  EXPECT_EQ(html.find("<script"), std::string::npos);
  EXPECT_EQ(html.find("<link"), std::string::npos);
  EXPECT_EQ(count_of(html, " src=\""), count_of(html, " src=\"data:image/png;base64,"));
  EXPECT_EQ(count_of(html, " href=\""), count_of(html, " href=\"#section-"));
}

TEST(HtmlReport, EscapesEveryText) {
  const std::string html = html_report(example_report());
  EXPECT_NE(html.find("<h1>Plate &lt;A&amp;B&gt; &quot;7&quot;</h1>"), std::string::npos);
  EXPECT_NE(html.find("<p>Second &#39;paragraph&#39; with x &lt; y.</p>"), std::string::npos);
  EXPECT_NE(html.find("alt=\"A &lt;caption&gt;\""), std::string::npos);
  EXPECT_NE(html.find("&lt;two&gt;"), std::string::npos);
  EXPECT_NE(html.find("Section &amp; more"), std::string::npos);
}

TEST(HtmlReport, CarriesPicturesNumbersDateAndVersion) {
  const std::string html = html_report(example_report());
  EXPECT_NE(html.find("base64," + base64(example_png()) + "\""), std::string::npos);
  EXPECT_NE(html.find("Figure 5."), std::string::npos);
  EXPECT_NE(html.find("Table 6."), std::string::npos);
  EXPECT_NE(html.find("2026-01-31 12:00 UTC"), std::string::npos);
  EXPECT_NE(html.find(std::string("Facula ") + version()), std::string::npos);
}

TEST(HtmlReport, PutsTheSummaryBeforeEverySection) {
  const std::string html = html_report(example_report());
  EXPECT_LT(html.find("At a glance"), html.find("<section"));
}

TEST(HtmlReport, SetsColumnsOfFiguresFlushRight) {
  const std::string html = html_report(example_report());
  EXPECT_NE(html.find("<td>one</td><td class=\"figure\">-1.5</td>"), std::string::npos);
  EXPECT_NE(html.find("<th scope=\"col\">a</th><th scope=\"col\" class=\"figure\">b</th>"),
            std::string::npos);
}

TEST(HtmlReport, RefusesARowOfAnotherLength) {
  Report report = example_report();
  report.sections[0].tables[0].rows.push_back({"alone"});
  EXPECT_NE(error_of([&] { html_report(report); }).find("2 columns but a row of 1 cells"),
            std::string::npos);
}

TEST(HtmlReport, StampsTheTimeWhenNoDateIsGiven) {
  EXPECT_EQ(html_report(example_report()).find("<dd>2026-01-31 12:00 UTC</dd>"),
            html_report(example_report()).find("<dd>"));
  const std::string html = html_report(Report{});
  const std::size_t at = html.find("<dt>Date</dt><dd>20");
  ASSERT_NE(at, std::string::npos);
  EXPECT_NE(html.find(" UTC</dd>", at), std::string::npos);
}

TEST(HtmlReport, IsWrittenWhole) {
  const TemporaryFolder folder;
  Report report = example_report();
  write_html_report(folder / "report.html", report);
  std::ifstream file(folder / "report.html", std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  EXPECT_EQ(text.str(), html_report(report));
  report.sections[0].tables[0].rows.push_back({});
  EXPECT_THROW(write_html_report(folder / "bad.html", report), std::runtime_error);
  EXPECT_FALSE(std::filesystem::exists(folder / "bad.html"));
}

TEST(HtmlText, DropsControlCharactersAndReplacesBrokenUtf8) {
  EXPECT_EQ(html_escaped(std::string("a\0b\x01\tc\n", 7)), "ab\tc\n");
  EXPECT_EQ(html_escaped("µ ± °"), "µ ± °");
  const std::string sign = "\xEF\xBF\xBD";
  EXPECT_EQ(html_escaped("\xB5m"), sign + "m");                 // Latin-1
  EXPECT_EQ(html_escaped("\xC0\xAF"), sign + sign);             // overlong '/'
  EXPECT_EQ(html_escaped("x\xE2\x82"), "x" + sign + sign);      // torn at the end
  EXPECT_EQ(html_escaped("\xED\xA0\x80"), sign + sign + sign);  // surrogate
}

TEST(HtmlText, TellsFiguresFromWords) {
  for (const char* cell : {"12.3",
                           "-4 mm",
                           "± 0.2",
                           "99 %",
                           "1 200",
                           "3.1e-5",
                           "-",
                           "n/a",
                           ".5",
                           "12.3 ± 0.4 µm",
                           "+7",
                           "< 0.1 mm",
                           "20 °C"}) {
    EXPECT_TRUE(is_figure(cell)) << cell;
  }
  for (const char* cell : {"",
                           "one",
                           "2026-01-31",
                           "12:30",
                           "3 of 4 walls",
                           "1.2.3",
                           "scan_1.pcd",
                           "(0, 0, 1)",
                           "--"}) {
    EXPECT_FALSE(is_figure(cell)) << cell;
  }
}

TEST(Base64, AgreesWithTheVectorsOfRfc4648) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foob"), "Zm9vYg==");
  EXPECT_EQ(base64("fooba"), "Zm9vYmE=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xFB\xFF\xBF"), "+/+/");
}

}  // namespace
}  // namespace facula
