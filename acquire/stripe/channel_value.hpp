// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/stripe/channel.hpp>

#include <algorithm>

namespace facula {

/// The weights of red, green and blue in grey, in 256ths: their sum stays within 16 bits.
constexpr int kGreyRed = 77;
constexpr int kGreyGreen = 150;
constexpr int kGreyBlue = 29;

/// One channel of one colour pixel, -255 to 255 [DN].
template <Channel kChannel>
constexpr int channel_value(int b, int g, int r) {
  switch (kChannel) {
    case Channel::kGrey:
      return (kGreyRed * r + kGreyGreen * g + kGreyBlue * b + 128) >> 8;
    case Channel::kRed:
      return r;
    case Channel::kGreen:
      return g;
    case Channel::kBlue:
      return b;
    case Channel::kRedExcess:
      return r - std::max(g, b);
    case Channel::kGreenExcess:
      return g - std::max(r, b);
    case Channel::kBlueExcess:
      return b - std::max(r, g);
    case Channel::kMaximum:
      return std::max({r, g, b});
  }
  return 0;
}

/// Calls work.template operator()<channel>() for the channel given.
template <typename Work>
void with_channel(Channel channel, const Work& work) {
  switch (channel) {
    case Channel::kGrey:
      return work.template operator()<Channel::kGrey>();
    case Channel::kRed:
      return work.template operator()<Channel::kRed>();
    case Channel::kGreen:
      return work.template operator()<Channel::kGreen>();
    case Channel::kBlue:
      return work.template operator()<Channel::kBlue>();
    case Channel::kRedExcess:
      return work.template operator()<Channel::kRedExcess>();
    case Channel::kGreenExcess:
      return work.template operator()<Channel::kGreenExcess>();
    case Channel::kBlueExcess:
      return work.template operator()<Channel::kBlueExcess>();
    case Channel::kMaximum:
      return work.template operator()<Channel::kMaximum>();
  }
}

}  // namespace facula
