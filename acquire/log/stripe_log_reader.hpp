// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/capture/capture.hpp>
#include <facula/acquire/log/log_header.hpp>
#include <facula/acquire/log/log_record.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace facula {

/// What of a log could not be used.
struct LogDamage {
  std::size_t dropped_records = 0;  ///< damaged within [1]
  std::uint64_t torn_bytes = 0;     ///< behind the last whole record [1]
};

/// A stripe log open for reading. Opening reads the heads of the records only; a frame is read and
/// checked when it is asked for, so that memory does not grow with the log.
class StripeLogReader {
 public:
  /// Throws Error for a file that is missing, foreign, of another version, or damaged in its
  /// header. Damage behind that is stepped over and told in damage().
  explicit StripeLogReader(const std::filesystem::path& path);
  ~StripeLogReader();
  StripeLogReader(const StripeLogReader&) = delete;
  StripeLogReader& operator=(const StripeLogReader&) = delete;

  const StripeLogHeader& header() const { return header_; }

  /// The capture that was recorded, without frames and positions.
  const Capture& settings() const { return settings_; }

  /// Records found by their heads, one per frame (of several of one frame the last), by frame.
  std::size_t size() const { return entries_.size(); }

  /// Number of the frame in record i.
  std::size_t frame_index(std::size_t i) const { return entries_[i].head.index; }

  /// One more than the highest number of a frame: the columns of the scan.
  std::size_t columns() const { return entries_.empty() ? 0 : entries_.back().head.index + 1; }

  /// Record i; none when it is damaged. Calls may run from several threads.
  std::optional<LoggedFrame> read(std::size_t i) const;

  /// What was stepped over when opening: records with a damaged head, and the torn end. Records
  /// that read() refuses come on top.
  const LogDamage& damage() const { return damage_; }

  std::uint64_t bytes() const { return bytes_; }              ///< of the file [1]
  std::uint64_t sound_bytes() const { return sound_bytes_; }  ///< up to the torn end [1]
  const std::string& name() const { return name_; }

 private:
  struct Entry {
    RecordHead head;
    std::uint64_t at = 0;  ///< of the payload
  };

  void read_header();
  void find_records();
  std::uint64_t next_head(std::uint64_t from) const;
  void keep_last_of_each_frame();
  void read_common_background(const Entry& entry);
  bool read_at(std::uint64_t at, std::uint8_t* data, std::size_t size) const;

  std::string name_;
  int file_ = -1;
  std::uint64_t bytes_ = 0;
  std::uint64_t sound_bytes_ = 0;
  StripeLogHeader header_;
  Capture settings_;
  std::vector<Entry> entries_;
  std::optional<Image8> common_background_;
  LogDamage damage_;
};

}  // namespace facula
