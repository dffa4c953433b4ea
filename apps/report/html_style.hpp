// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace facula {

/// The style sheet of html_report(): light and dark, narrow and wide, screen and paper.
extern const char* const kReportStyle;

}  // namespace facula
