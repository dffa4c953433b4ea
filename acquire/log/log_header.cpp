// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/log/log_header.hpp>

#include <algorithm>
#include <array>

namespace facula {
namespace {

constexpr std::array<std::uint8_t, 8> kMagic = {'F', 'A', 'C', 'U', 'L', 'O', 'G', 0x1A};
constexpr std::uint32_t kVersion = 1;
constexpr std::size_t kChecked = 20;  // bytes before those that the checksum covers
constexpr std::size_t kLongestHeader = std::size_t{1} << 26;

std::string take_text(ByteReader& in, std::size_t size) {
  const ByteView view = in.take_view(size);
  return {view.begin(), view.end()};
}

bool sizes_are_sane(const StripeLogHeader& h, std::uint32_t background) {
  return h.rows > 0 && h.rows <= 100000 && h.cols > 0 && h.cols < 65535 &&
         (h.channels == 1 || h.channels == 3) && h.width > 0 && h.width <= 254 &&
         h.width <= h.cols && h.exposures >= 1 && h.exposures <= 16 && background <= 2;
}

}  // namespace

Bytes encode_header(const StripeLogHeader& header) {
  require(
      sizes_are_sane(header, static_cast<std::uint32_t>(header.background)),
      "a stripe log holds rows shorter than 65535 px of frames with at most 100000 rows, 1 or 3 "
      "channels and 16 exposures, got ",
      header.rows,
      " rows of ",
      header.cols,
      " px, ",
      header.channels,
      " channels, ",
      header.exposures,
      " exposures, windows of ",
      header.width,
      " px");
  Bytes out(kMagic.begin(), kMagic.end());
  put(out, kVersion);
  put(out, std::uint32_t{0});  // length and checksum, filled in below
  put(out, std::uint32_t{0});
  put(out, static_cast<std::uint32_t>(header.rows));
  put(out, static_cast<std::uint32_t>(header.cols));
  put(out, static_cast<std::uint32_t>(header.channels));
  put(out, static_cast<std::uint32_t>(header.width));
  put(out, static_cast<std::uint32_t>(header.exposures));
  put(out, static_cast<std::uint32_t>(header.bed ? 1 : 0));
  put(out, static_cast<std::uint32_t>(header.background));
  put(out, static_cast<std::uint64_t>(header.frames));
  put(out, static_cast<std::uint32_t>(header.rig.size()));
  put(out, static_cast<std::uint32_t>(header.settings.size()));
  put_bytes(out, header.rig.data(), header.rig.size());
  put_bytes(out, header.settings.data(), header.settings.size());
  require(out.size() <= kLongestHeader, "the rig's text is too long for a stripe log");
  put_at(out, 12, static_cast<std::uint32_t>(out.size()));
  put_at(out, 16, crc32_of(ByteView(out).subspan(kChecked)));
  return out;
}

std::size_t header_length(ByteView fixed, const std::string& name) {
  const std::size_t known = std::min(fixed.size(), kMagic.size());
  require(known > 0 &&
              std::equal(fixed.begin(), fixed.begin() + static_cast<long>(known), kMagic.begin()),
          "'",
          name,
          "' is no stripe log; name a file that 'facula extract --log' wrote");
  require(fixed.size() >= kFixedHeaderBytes,
          "'",
          name,
          "' is a stripe log that ends within its header, so that nothing can be read from it; "
          "record again");
  ByteReader in(fixed.subspan(kMagic.size()));
  const auto version = in.take<std::uint32_t>();
  require(version == kVersion,
          "'",
          name,
          "' is a stripe log of version ",
          version,
          ", and this program reads version ",
          kVersion,
          "; read it with the program that wrote it");
  const std::size_t length = in.take<std::uint32_t>();
  require(length >= kFixedHeaderBytes && length <= kLongestHeader,
          "the header of the stripe log '",
          name,
          "' is damaged (its length reads ",
          length,
          "); restore the file from a copy");
  return length;
}

StripeLogHeader decode_header(ByteView bytes, const std::string& name) {
  const std::size_t length = header_length(bytes, name);
  require(bytes.size() >= length,
          "'",
          name,
          "' is a stripe log that ends within its header, so that nothing can be read from it; "
          "record again");
  bytes = bytes.first(length);
  ByteReader in(bytes.subspan(16));
  const auto checksum = in.take<std::uint32_t>();
  StripeLogHeader h;
  h.rows = static_cast<int>(in.take<std::uint32_t>());
  h.cols = static_cast<int>(in.take<std::uint32_t>());
  h.channels = static_cast<int>(in.take<std::uint32_t>());
  h.width = static_cast<int>(in.take<std::uint32_t>());
  h.exposures = static_cast<int>(in.take<std::uint32_t>());
  h.bed = in.take<std::uint32_t>() != 0;
  const auto background = in.take<std::uint32_t>();
  h.background = static_cast<LoggedBackground>(background);
  h.frames = in.take<std::uint64_t>();
  const auto rig_bytes = in.take<std::uint32_t>();
  const auto settings_bytes = in.take<std::uint32_t>();
  h.rig = take_text(in, rig_bytes);
  h.settings = take_text(in, settings_bytes);
  require(checksum == crc32_of(bytes.subspan(kChecked)) && !in.failed() && in.left() == 0 &&
              sizes_are_sane(h, background),
          "the header of the stripe log '",
          name,
          "' is damaged (its checksum differs); restore the file from a copy");
  return h;
}

}  // namespace facula
