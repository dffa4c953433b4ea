// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/atomic_file.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/apps/report/report_pictures.hpp>

#include <string>
#include <system_error>

namespace facula {
namespace {

std::string two_digits(std::size_t number) {
  return (number < 10 ? "0" : "") + std::to_string(number);
}

}  // namespace

std::size_t write_report_pictures(const std::filesystem::path& folder, const Report& report) {
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  require(!failure, "cannot make the folder '", folder.string(), "': ", failure.message());
  std::size_t written = 0;
  for (std::size_t s = 0; s < report.sections.size(); ++s) {
    const auto& pictures = report.sections[s].pictures;
    for (std::size_t p = 0; p < pictures.size(); ++p, ++written) {
      AtomicFile file(folder / (two_digits(s + 1) + "-" + two_digits(p + 1) + ".png"));
      file.stream() << pictures[p].png;
      file.commit();
    }
  }
  return written;
}

}  // namespace facula
