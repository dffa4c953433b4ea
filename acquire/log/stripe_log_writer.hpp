// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/image_view.hpp>
#include <facula/acquire/log/log_bytes.hpp>
#include <facula/acquire/log/log_header.hpp>

#include <cstdint>
#include <filesystem>
#include <mutex>

namespace facula {

/// Appends frames to a stripe log, each synced to the disk before append() returns: whatever
/// happens afterwards, that frame is there. One writer per file, also between programs.
class StripeLogWriter {
 public:
  /// Begins a new log. `common_background` goes with LoggedBackground::kCommon, rows as in the log.
  /// Throws Error when a file of that name exists (it may hold a recording) or cannot be written.
  static StripeLogWriter create(const std::filesystem::path& path,
                                const StripeLogHeader& header,
                                ImageView8 common_background);

  /// Continues a log that was read up to `read_bytes`, its whole length then: cuts off all behind
  /// `sound_bytes`, the end of its last whole record. Throws Error where it has grown since.
  static StripeLogWriter resume(const std::filesystem::path& path,
                                std::uint64_t sound_bytes,
                                std::uint64_t read_bytes);

  StripeLogWriter(StripeLogWriter&& other) noexcept;
  StripeLogWriter& operator=(StripeLogWriter&&) = delete;
  ~StripeLogWriter();

  /// Adds the record of a frame (encode_frame()); calls may come from several threads and in any
  /// order of frames. A frame that cannot be written whole (disk full) is taken back, and Error is
  /// thrown.
  void append(const Bytes& record);

  std::uint64_t bytes() const { return bytes_; }  ///< of the whole file

 private:
  StripeLogWriter(std::filesystem::path path, std::uint64_t keep, std::uint64_t expected);

  std::filesystem::path path_;
  int file_ = -1;
  std::uint64_t bytes_ = 0;
  std::mutex mutex_;
};

}  // namespace facula
