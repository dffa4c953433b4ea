// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace facula {

/// Text as it may stand in HTML, in elements and attribute values; control characters other than
/// tab and line end are dropped, bytes that are not UTF-8 become the replacement character.
std::string html_escaped(const std::string& text);

/// Paragraphs, separated by empty lines, as <p> elements.
std::string html_paragraphs(const std::string& text);

/// Whether a table cell is a figure: "12.3", "-4 mm", "± 0.2", "99 %", "1 200", "3.1e-5", or the
/// stand-ins "-" and "n/a".
bool is_figure(const std::string& cell);

}  // namespace facula
