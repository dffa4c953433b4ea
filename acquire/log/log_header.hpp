// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/log/log_bytes.hpp>

#include <cstddef>
#include <cstdint>
#include <string>

namespace facula {

/// Where the frames without the laser are.
enum class LoggedBackground : std::uint32_t {
  kNone = 0,
  kPerFrame = 1,  ///< windows of them with every frame
  kCommon = 2     ///< one whole frame at the start of the log
};

/// What stands once at the start of a stripe log (docs/stripe_log.md has the bytes).
struct StripeLogHeader {
  int rows = 0;       ///< rows of the scan: frame rows, or columns of a stripe per column [px]
  int cols = 0;       ///< pixels along such a row [px]
  int channels = 1;   ///< 1 or 3 [1]
  int width = 0;      ///< of the windows [px]
  int exposures = 1;  ///< of every frame, merged when measured, 1 to 16 [1]
  bool bed = false;   ///< a bare bed was recorded with every frame (zero line)
  LoggedBackground background = LoggedBackground::kNone;
  std::size_t frames = 0;  ///< of the whole recording, 0 where nobody knows yet [1]
  std::string rig;         ///< text of rig.toml
  std::string settings;    ///< what capture.toml said, see log_settings.hpp

  /// Images with windows of their own per frame: the exposures, then the bed [1].
  int views() const { return exposures + (bed ? 1 : 0); }

  /// Bytes of one raw frame [1].
  std::size_t frame_bytes() const {
    return static_cast<std::size_t>(rows) * static_cast<std::size_t>(cols) *
           static_cast<std::size_t>(channels);
  }

  /// Bytes of the images that `count` frames were measured from, dark ones and bare bed included;
  /// two images that were made one by their mean count as one [1].
  std::size_t raw_bytes(std::size_t count) const {
    const int dark = background == LoggedBackground::kPerFrame ? exposures : 0;
    const std::size_t common = background == LoggedBackground::kCommon ? 1 : 0;
    return (static_cast<std::size_t>(views() + dark) * count + common) * frame_bytes();
  }
};

inline constexpr std::size_t kFixedHeaderBytes = 64;  ///< before the texts

/// The header's bytes with their checksum.
Bytes encode_header(const StripeLogHeader& header);

/// Length of the whole header by its first kFixedHeaderBytes bytes. Throws Error, each with a
/// sentence of its own, for a foreign file, one of another version, and one too short to be a log;
/// `name` is what it calls the file.
std::size_t header_length(ByteView fixed, const std::string& name);

/// Throws Error when the checksum or a size is wrong.
StripeLogHeader decode_header(ByteView bytes, const std::string& name);

}  // namespace facula
