// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/log/log_settings.hpp>
#include <facula/acquire/log/stripe_log_reader.hpp>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace facula {
namespace {

constexpr std::uint64_t kMostFrames = 10'000'000;  // a year of one frame every three seconds

}  // namespace

StripeLogReader::StripeLogReader(const std::filesystem::path& path) : name_(path.string()) {
  require(std::filesystem::is_regular_file(path),
          "cannot read the stripe log '",
          name_,
          "': there is no such file; check the path");
  file_ = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  require(file_ >= 0, "cannot read the stripe log '", name_, "': ", std::strerror(errno));
  try {
    bytes_ = std::filesystem::file_size(path);
    read_header();
    find_records();
  } catch (...) {
    close(std::exchange(file_, -1));
    throw;
  }
}

StripeLogReader::~StripeLogReader() {
  if (file_ >= 0) close(file_);
}

bool StripeLogReader::read_at(std::uint64_t at, std::uint8_t* data, std::size_t size) const {
  while (size > 0) {
    const ssize_t got = pread(file_, data, size, static_cast<off_t>(at));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    at += static_cast<std::uint64_t>(got);
    data += got;
    size -= static_cast<std::size_t>(got);
  }
  return true;
}

void StripeLogReader::read_header() {
  Bytes bytes(std::min<std::uint64_t>(bytes_, kFixedHeaderBytes));
  require(read_at(0, bytes.data(), bytes.size()), "cannot read the stripe log '", name_, "'");
  const std::size_t length = header_length(bytes, name_);
  bytes.resize(std::min<std::uint64_t>(bytes_, length));
  require(read_at(0, bytes.data(), bytes.size()), "cannot read the stripe log '", name_, "'");
  header_ = decode_header(bytes, name_);
  settings_ = capture_of(header_, name_);
  sound_bytes_ = length;
}

void StripeLogReader::find_records() {
  std::uint64_t at = sound_bytes_;
  while (at < bytes_) {
    std::array<std::uint8_t, kRecordHeadBytes> start{};
    const bool there = bytes_ - at >= start.size() && read_at(at, start.data(), start.size());
    const auto head = there ? decode_head(start, header_) : std::nullopt;
    const std::uint64_t most = header_.frames > 0 ? header_.frames : kMostFrames;
    if (!head || head->index >= most) {
      const std::uint64_t next = next_head(at + 1);
      if (next == bytes_) break;
      ++damage_.dropped_records;
      at = next;
      continue;
    }
    const std::uint64_t end = at + kRecordHeadBytes + head->payload;
    if (end > bytes_) break;
    const Entry entry{*head, at + kRecordHeadBytes};
    if (head->kind == RecordKind::kFrame) {
      entries_.push_back(entry);
    } else {
      read_common_background(entry);
    }
    at = end;
    sound_bytes_ = end;
  }
  damage_.torn_bytes = bytes_ - sound_bytes_;
  keep_last_of_each_frame();
  require(header_.background != LoggedBackground::kCommon || common_background_.has_value(),
          "the background frame at the start of the stripe log '",
          name_,
          "' is damaged, and without it no stripe can be measured; restore the file from a copy");
}

/// Where the next sound head begins, the file's length where there is none.
std::uint64_t StripeLogReader::next_head(std::uint64_t from) const {
  constexpr std::size_t kPart = std::size_t{1} << 20;
  Bytes part;
  for (std::uint64_t at = from; at + kRecordHeadBytes <= bytes_;
       at += part.size() - kRecordHeadBytes + 1) {
    part.resize(std::min<std::uint64_t>(kPart, bytes_ - at));
    if (!read_at(at, part.data(), part.size())) return bytes_;
    for (std::size_t i = 0; i + kRecordHeadBytes <= part.size(); ++i) {
      if (decode_head(ByteView(part).subspan(i), header_)) return at + i;
    }
  }
  return bytes_;
}

void StripeLogReader::keep_last_of_each_frame() {
  std::stable_sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
    return a.head.index < b.head.index;
  });
  std::vector<Entry> last;
  for (const Entry& entry : entries_) {
    if (!last.empty() && last.back().head.index == entry.head.index) last.pop_back();
    last.push_back(entry);
  }
  entries_ = std::move(last);
}

void StripeLogReader::read_common_background(const Entry& entry) {
  Bytes payload(entry.head.payload);
  if (!read_at(entry.at, payload.data(), payload.size())) return;
  common_background_ = decode_background(entry.head, payload, header_);
}

std::optional<LoggedFrame> StripeLogReader::read(std::size_t i) const {
  const Entry& entry = entries_[i];
  thread_local Bytes payload;
  payload.resize(entry.head.payload);
  if (!read_at(entry.at, payload.data(), payload.size())) return std::nullopt;
  std::optional<LoggedFrame> frame = decode_frame(entry.head, payload, header_);
  if (frame && header_.background == LoggedBackground::kCommon) {
    StripeWindows& windows = frame->views[0].windows;
    const WindowPlaces places{header_.width, windows.begin};
    windows.dark = cut_windows(common_background_->view(), {}, places, false).lit;
  }
  return frame;
}

}  // namespace facula
