// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/stripe/channel.hpp>
#include <facula/acquire/stripe/channel_value.hpp>

#include <algorithm>
#include <array>
#include <utility>

namespace facula {
namespace {

constexpr std::array<std::pair<Channel, const char*>, 8> kNames = {{
    {Channel::kGrey, "grey"},
    {Channel::kRed, "red"},
    {Channel::kGreen, "green"},
    {Channel::kBlue, "blue"},
    {Channel::kRedExcess, "red-excess"},
    {Channel::kGreenExcess, "green-excess"},
    {Channel::kBlueExcess, "blue-excess"},
    {Channel::kMaximum, "maximum"},
}};

/// Calls write(column, value) for every pixel of a row, the colour formula chosen once per row.
template <typename Write>
void read_any_row(ImageView8 frame, int r, Channel channel, const Write& write) {
  const std::uint8_t* pixels = frame.row(r);
  if (frame.channels != 3) {
    for (int c = 0; c < frame.cols; ++c) write(c, int{pixels[c]});
    return;
  }
  with_channel(channel, [&]<Channel kChannel>() {
    for (int c = 0; c < frame.cols; ++c, pixels += 3) {
      write(c, channel_value<kChannel>(pixels[0], pixels[1], pixels[2]));
    }
  });
}

void check_channels(ImageView8 frame) {
  require(frame.empty() || frame.channels == 1 || frame.channels == 3,
          "expected a grey frame or one of 3 colours, got ",
          frame.channels,
          " channels");
}

}  // namespace

Channel channel_from_name(const std::string& name) {
  for (const auto& [channel, known] : kNames) {
    if (name == known) return channel;
  }
  std::string all;
  for (const auto& [channel, known] : kNames) all += std::string(all.empty() ? "" : ", ") + known;
  fail("expected a channel (", all, "), got '", name, "'");
}

std::string to_string(Channel channel) {
  for (const auto& [known, name] : kNames) {
    if (known == channel) return name;
  }
  return "grey";
}

Image8 extract_channel(ImageView8 frame, Channel channel) {
  check_channels(frame);
  Image8 result(frame.rows, frame.cols);
  for (int r = 0; r < frame.rows; ++r) {
    std::uint8_t* out = result.row(r);
    read_any_row(frame, r, channel, [&](int c, int value) {
      out[c] = static_cast<std::uint8_t>(std::clamp(value, 0, 255));
    });
  }
  return result;
}

void read_channel_row(ImageView8 frame, int r, Channel channel, std::int16_t* values) {
  read_any_row(
      frame, r, channel, [&](int c, int value) { values[c] = static_cast<std::int16_t>(value); });
}

}  // namespace facula
