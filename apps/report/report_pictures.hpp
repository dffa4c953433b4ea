// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/report/html_report.hpp>

#include <cstddef>
#include <filesystem>

namespace facula {

/// Writes every picture of a report as NN-MM.png into a folder, which is made when it is not there:
/// section NN, picture MM, both from 01 as in the page. Returns how many. Files of other names
/// stay.
std::size_t write_report_pictures(const std::filesystem::path& folder, const Report& report);

}  // namespace facula
