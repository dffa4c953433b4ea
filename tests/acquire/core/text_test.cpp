// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/lzf.hpp>
#include <facula/acquire/core/nearest_name.hpp>
#include <facula/acquire/core/text_numbers.hpp>

#include <clocale>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace facula {
namespace {

TEST(NearestName, FindsTheNameThatWasMeant) {
  const std::vector<std::string> known{"camera", "laser", "axis", "compensation"};
  EXPECT_EQ(nearest_name("camrea", known), "camera");
  EXPECT_EQ(nearest_name("lasers", known), "laser");
  EXPECT_EQ(nearest_name("axes", known), "axis");
  EXPECT_EQ(nearest_name("compensasion", known), "compensation");
  EXPECT_EQ(nearest_name("axis", known), "axis");
}

TEST(NearestName, IsEmptyWhenNothingIsNear) {
  EXPECT_EQ(nearest_name("turntable", {"camera", "laser", "axis"}), "");
  EXPECT_EQ(nearest_name("", {"axis"}), "");
  EXPECT_EQ(nearest_name("axis", {}), "");
}

TEST(TextNumbers, ReadsWholeWordsOnly) {
  EXPECT_EQ(parse_number<double>("-2.5e3"), -2500);
  EXPECT_EQ(parse_number<double>("+4"), 4);
  EXPECT_TRUE(std::isnan(parse_number<double>("nan").value()));
  for (const char* bad : {"", "1.5x", " 1", "1,5", "+-1", "++1", "0x10", "one"}) {
    EXPECT_FALSE(parse_number<double>(bad).has_value()) << bad;
  }
  EXPECT_FALSE(parse_number<int>("1.5").has_value());
  EXPECT_FALSE(parse_number<std::size_t>("-1").has_value());
  EXPECT_FALSE(parse_number<int>("99999999999").has_value());
}

TEST(TextNumbers, WritesWhatReadsBackTheSame) {
  for (const double value : {1.0 / 3, -0.0, 1e300, 5e-324, 0.1}) {
    EXPECT_EQ(parse_number<double>(number_text(value)), value);
  }
  EXPECT_EQ(number_text(0.1F), "0.1");
  EXPECT_TRUE(std::signbit(parse_number<double>(number_text(-0.0)).value()));
}

TEST(TextNumbers, CutsLinesAndWords) {
  std::string_view text = "one  two\r\n\nthree";
  std::string_view line = take_line(text);
  EXPECT_EQ(take_word(line), "one");
  EXPECT_EQ(take_word(line), "two");
  EXPECT_EQ(take_word(line), "");
  EXPECT_EQ(take_line(text), "");
  EXPECT_EQ(take_line(text), "three");
  EXPECT_TRUE(text.empty());
}

TEST(Lzf, UnpacksPlainBytesAndOverlappingCopies) {
  // Three plain bytes, then a copy of 7 from 3 back: control 5 << 5 | 0, low byte 2.
  const std::string packed{'\x02', 'a', 'b', 'c', '\xA0', '\x02'};
  EXPECT_EQ(unpack_lzf(packed, 10), "abcabcabca");
  // A long copy: length 7 in the control means 9 and the next byte more.
  const std::string run{'\x00', 'z', '\xE0', '\x0A', '\x00'};
  EXPECT_EQ(unpack_lzf(run, 20), std::string(20, 'z'));
}

TEST(Lzf, RefusesTornBlocks) {
  const std::string packed{'\x02', 'a', 'b', 'c', '\xA0', '\x02'};
  EXPECT_FALSE(unpack_lzf(packed, 9).has_value());
  EXPECT_FALSE(unpack_lzf(packed, 11).has_value());
  EXPECT_FALSE(unpack_lzf(packed.substr(0, 5), 10).has_value());
  EXPECT_FALSE(unpack_lzf(packed.substr(0, 2), 3).has_value());
  EXPECT_FALSE(unpack_lzf(std::string{'\x20', '\x00'}, 3).has_value());  // copies from nothing
  EXPECT_FALSE(unpack_lzf(packed, std::numeric_limits<std::size_t>::max()).has_value());
}

}  // namespace
}  // namespace facula
