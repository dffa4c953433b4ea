// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/report/html_style.hpp>

namespace facula {

const char* const kReportStyle = R"css(
:root {
  color-scheme: light dark;
  --page: #ffffff; --ink: #1f242c; --soft: #5b6472; --line: #d9dde3; --faint: #f4f6f8;
  --accent: #1c5f8a; --plate: #ffffff; --dimmed: none;
}
@media (prefers-color-scheme: dark) {
  :root {
    --page: #15181d; --ink: #e4e7ec; --soft: #9aa4b2; --line: #333a44; --faint: #1d2128;
    --accent: #7cc0ea; --plate: #ffffff; --dimmed: brightness(.88);
  }
}
* { box-sizing: border-box; }
html { -webkit-text-size-adjust: 100%; }
body {
  margin: 0; background: var(--page); color: var(--ink);
  font: 400 1rem/1.6 "Source Sans 3", "Segoe UI", "Helvetica Neue", Helvetica, Arial, sans-serif;
  font-kerning: normal;
}
main, .masthead, .imprint { max-width: 68rem; margin: 0 auto; padding: 0 1.5rem; }
.masthead { padding-top: 3rem; }
.masthead .mark {
  margin: 0; color: var(--accent); font-size: .8rem; font-weight: 600; letter-spacing: .14em;
  text-transform: uppercase;
}
h1 { margin: .3rem 0 .6rem; font-size: clamp(1.7rem, 4vw, 2.4rem); line-height: 1.2;
  font-weight: 600; letter-spacing: -.01em; overflow-wrap: anywhere; }
h2 { margin: 3rem 0 .8rem; padding-top: 1.1rem; border-top: 1px solid var(--line);
  font-size: 1.35rem; line-height: 1.3; font-weight: 600; overflow-wrap: anywhere; }
h2 .number { margin-right: .6em; color: var(--soft); font-weight: 400; }
p { max-width: 44rem; margin: 0 0 .9rem; overflow-wrap: anywhere; }
dl.facts { display: flex; flex-wrap: wrap; gap: .3rem 2.2rem; margin: 0 0 1.6rem;
  padding: .7rem 0; border-top: 2px solid var(--accent); border-bottom: 1px solid var(--line);
  font-size: .92rem; }
dl.facts div { display: flex; gap: .5rem; }
dl.facts dt { color: var(--soft); }
dl.facts dd { margin: 0; font-variant-numeric: tabular-nums; }
nav ol { margin: 0 0 1rem; padding-left: 1.4rem; columns: 18rem; }
a { color: var(--accent); text-underline-offset: .15em; }
figure { margin: 1.6rem 0; break-inside: avoid; }
figure img { display: block; max-width: 100%; height: auto; padding: .75rem; background: var(--plate);
  border: 1px solid var(--line); border-radius: 4px; filter: var(--dimmed); }
figcaption, caption { color: var(--soft); font-size: .92rem; line-height: 1.45; text-align: left; }
figcaption { max-width: 48rem; margin-top: .55rem; }
figcaption b, caption b { color: var(--ink); font-weight: 600; }
.scroll { overflow-x: auto; margin: 1.4rem 0; break-inside: avoid; }
table { border-collapse: collapse; font-size: .95rem; line-height: 1.4;
  border-bottom: 1.5px solid var(--ink); }
caption { padding-bottom: .5rem; }
th { border-top: 1.5px solid var(--ink); border-bottom: 1px solid var(--ink); font-weight: 600;
  text-align: left; vertical-align: bottom; }
th, td { padding: .38rem 1.4rem .38rem .2rem; }
th:last-child, td:last-child { padding-right: .2rem; }
td { border-bottom: 1px solid var(--line); vertical-align: top; }
tbody tr:last-child td { border-bottom: 0; }
tbody tr:nth-child(even) td { background: var(--faint); }
th.figure, td.figure { text-align: right; font-variant-numeric: tabular-nums lining-nums; }
td.figure { white-space: nowrap; }
.wide th, .wide td { padding-right: .55rem; font-size: .85rem; }
.summary table { width: 100%; max-width: 44rem; font-size: 1rem; }
.imprint { margin-top: 3.5rem; padding-top: 1rem; padding-bottom: 3rem; color: var(--soft);
  font-size: .85rem; }
.imprint p { padding-top: 1rem; border-top: 1px solid var(--line); max-width: none; }
@media print {
  @page { size: A4; margin: 18mm 16mm; }
  :root { color-scheme: light; --page: #fff; --ink: #000; --soft: #444; --line: #bbb;
    --faint: #f6f6f6; --accent: #123f5c; --plate: #fff; }
  html { font-size: 10pt; }
  figure img { filter: none; }
  main, .masthead, .imprint { max-width: none; padding-left: 0; padding-right: 0; }
  .masthead { padding-top: 0; }
  .scroll { overflow: visible; }
  h2 { break-after: avoid; }
  thead { display: table-header-group; }
  tr { break-inside: avoid; }
  figure img { padding: 0; border: 0; max-height: 215mm; }
  a { color: inherit; text-decoration: none; }
}
)css";

}  // namespace facula
