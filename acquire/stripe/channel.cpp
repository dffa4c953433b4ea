// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/stripe/channel.hpp>

#include <algorithm>
#include <array>
#include <cmath>
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

float grey(float b, float g, float r) {
  return 0.114F * b + 0.587F * g + 0.299F * r;
}

/// Calls write(column, value) for every pixel of a row, the colour formula chosen once per row.
template <typename Write>
void read_row(const std::uint8_t* pixels, int cols, Channel channel, const Write& write) {
  const auto each = [&](const auto& value) {
    for (int c = 0; c < cols; ++c, pixels += 3) {
      write(c,
            value(static_cast<float>(pixels[0]),
                  static_cast<float>(pixels[1]),
                  static_cast<float>(pixels[2])));
    }
  };
  switch (channel) {
    case Channel::kGrey:
      return each(grey);
    case Channel::kRed:
      return each([](float, float, float r) { return r; });
    case Channel::kGreen:
      return each([](float, float g, float) { return g; });
    case Channel::kBlue:
      return each([](float b, float, float) { return b; });
    case Channel::kRedExcess:
      return each([](float b, float g, float r) { return r - std::max(g, b); });
    case Channel::kGreenExcess:
      return each([](float b, float g, float r) { return g - std::max(r, b); });
    case Channel::kBlueExcess:
      return each([](float b, float g, float r) { return b - std::max(r, g); });
    case Channel::kMaximum:
      return each([](float b, float g, float r) { return std::max({r, g, b}); });
  }
}

template <typename Write>
void read_any_row(ImageView8 frame, int r, Channel channel, const Write& write) {
  const std::uint8_t* pixels = frame.row(r);
  if (frame.channels == 3) return read_row(pixels, frame.cols, channel, write);
  for (int c = 0; c < frame.cols; ++c) write(c, static_cast<float>(pixels[c]));
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
    read_any_row(frame, r, channel, [&](int c, float value) {
      out[c] = static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0F, 255.0F)));
    });
  }
  return result;
}

void read_channel_row(ImageView8 frame, int r, Channel channel, std::int16_t* values) {
  read_any_row(frame, r, channel, [&](int c, float value) {
    values[c] = static_cast<std::int16_t>(std::lround(value));
  });
}

}  // namespace facula
