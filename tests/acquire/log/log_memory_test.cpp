// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/log/log_record.hpp>
#include <facula/acquire/log/log_settings.hpp>
#include <facula/acquire/log/stripe_log_writer.hpp>
#include <facula/tests/acquire/log/logged_wall.hpp>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace facula {
namespace {

/// A log of `frames` copies of one frame at different positions.
void write_log(const std::filesystem::path& path, int frames) {
  Capture capture;
  capture.rig = panning_head();
  capture.positions.assign(static_cast<std::size_t>(frames), 0.0);
  const StripeLogHeader header = header_of(capture, 1);
  Image8 image(120, 240);
  for (int r = 0; r < 120; ++r) {
    for (int c = 110; c < 130; ++c) {
      image.row(r)[c] = static_cast<std::uint8_t>(200 * std::exp(-0.125 * (c - 119) * (c - 119)));
    }
  }
  LoggedFrame frame;
  frame.views = {log_view({image.view(), {}}, capture.stripe, header.width)};
  auto writer = StripeLogWriter::create(path, header, {});
  for (int i = 0; i < frames; ++i) {
    frame.index = static_cast<std::size_t>(i);
    frame.position = 0.001 * i;
    writer.append(encode_frame(frame, header));
  }
}

/// Peak resident memory of a process of its own that makes the scan [bytes].
double memory_of_extraction(const std::filesystem::path& path) {
  const pid_t child = fork();
  if (child == 0) {
    const StripeLogReader log(path);
    const ExtractResult result = extract_scan(log, log.settings(), {.num_threads = 2});
    _exit(result.scan.valid_count() > 0 ? 0 : 1);
  }
  int status = 0;
  rusage usage{};
  EXPECT_EQ(wait4(child, &status, 0, &usage), child);
  EXPECT_EQ(status, 0);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

/// 33 bytes a cell are the scan, 90 a record's place and its column; the logs differ by 7 MB.
TEST(LogMemory, GrowsWithTheScanAndNotWithTheLog) {
  const TemporaryFolder folder;
  constexpr int kFew = 100;
  constexpr int kMany = 1200;
  write_log(folder / "few.flog", kFew);
  write_log(folder / "many.flog", kMany);
  const double log_growth = static_cast<double>(std::filesystem::file_size(folder / "many.flog") -
                                                std::filesystem::file_size(folder / "few.flog"));
  const double growth =
      memory_of_extraction(folder / "many.flog") - memory_of_extraction(folder / "few.flog");
  const double scan_growth = (kMany - kFew) * (120.0 * 33 + 150);
  RecordProperty("growth_bytes", static_cast<int>(growth));
  EXPECT_GT(log_growth, 6e6);
  EXPECT_LT(growth, 1.1 * scan_growth + 1.5e6);
}

}  // namespace
}  // namespace facula
