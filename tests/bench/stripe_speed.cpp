// SPDX-License-Identifier: GPL-3.0-or-later
//
// stripe_speed [--rounds N] [--json]: what the default stripe detector costs per frame on one core,
// beside a plain read of the same memory and beside a chain of OpenCV's functions. All of a size
// take turns, round by round; medians over the rounds, of times and of the ratios within a round.
#include <facula/acquire/stripe/stripe_detector.hpp>
#include <facula/tests/bench/bench_scene.hpp>
#include <facula/tests/bench/filter_chain_opencv.hpp>
#include <facula/tests/bench/plain_read.hpp>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

namespace facula {
namespace {

/// Frames in turn, so that a frame is not still in the nearest cache from the time before, but no
/// more than the farther cache holds.
struct Size {
  int cols;
  int rows;
  int frames;
};

constexpr Size kSizes[] = {{640, 480, 8}, {1920, 1080, 4}, {2560, 832, 4}};

struct Contender {
  std::string name;
  std::function<void(std::size_t frame)> run;
  std::vector<double> seconds;  ///< per frame, one entry per round
};

double median_of(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

/// The same frame in three colours: red as it was, the others a third of it.
Image8 in_colour(const Image8& grey) {
  Image8 colour(grey.rows, grey.cols, 3);
  for (std::size_t i = 0; i < grey.pixels.size(); ++i) {
    colour.pixels[3 * i] = static_cast<std::uint8_t>(grey.pixels[i] / 3);
    colour.pixels[3 * i + 1] = static_cast<std::uint8_t>(grey.pixels[i] / 3);
    colour.pixels[3 * i + 2] = grey.pixels[i];
  }
  return colour;
}

Image8 turned(const Image8& grey) {
  Image8 result(grey.cols, grey.rows);
  for (int r = 0; r < grey.rows; ++r) {
    for (int c = 0; c < grey.cols; ++c) result.row(c)[r] = grey.row(r)[c];
  }
  return result;
}

std::size_t unseen = 0;

void detect(const Image8& frame, const Image8* dark, const StripeOptions& options) {
  const StripeProfile profile =
      detect_stripe(frame.view(), dark != nullptr ? dark->view() : ImageView8{}, options);
  unseen += profile.size() - profile.seen_count();
}

struct Frames {
  std::vector<Image8> grey;
  std::vector<Image8> dark;
  std::vector<Image8> colour;
  std::vector<Image8> level;
};

Frames frames_of(const Size& size) {
  Frames frames;
  frames.grey = stripe_frames(size.rows, size.cols, size.frames);
  for (std::size_t i = 0; i < frames.grey.size(); ++i) {
    const Image8& frame = frames.grey[i];
    // Laser off: the noise of another frame.
    frames.dark.push_back(frames.grey[(i + 1) % frames.grey.size()]);
    for (auto& p : frames.dark.back().pixels) p = p < 16 ? p : std::uint8_t{8};
    frames.colour.push_back(in_colour(frame));
    frames.level.push_back(turned(frame));
  }
  return frames;
}

std::vector<Contender> contenders(const Frames& frames) {
  std::vector<Contender> all;
  all.push_back({"plain_read",
                 [&](std::size_t i) {
                   const Image8& frame = frames.grey[i];
                   static volatile std::uint64_t sink = 0;
                   sink = plain_read(frame.pixels.data(), frame.pixels.size());
                 },
                 {}});
  all.push_back({"fir", [&](std::size_t i) { detect(frames.grey[i], nullptr, {}); }, {}});
  all.push_back(
      {"fir_on_off", [&](std::size_t i) { detect(frames.grey[i], &frames.dark[i], {}); }, {}});
  all.push_back({"fir_colour", [&](std::size_t i) { detect(frames.colour[i], nullptr, {}); }, {}});
  all.push_back({"fir_level",
                 [&](std::size_t i) {
                   StripeOptions options;
                   options.direction = StripeDirection::kPerColumn;
                   detect(frames.level[i], nullptr, options);
                 },
                 {}});
  all.push_back({"opencv_chain",
                 [&](std::size_t i) {
                   static volatile float sink = 0;
                   sink = filter_chain(frames.grey[i].view())[0];
                 },
                 {}});
  return all;
}

/// One turn over all frames, repeated until a millisecond is over; a turn before it fills the
/// caches.
double seconds_per_frame(const Contender& contender, int count) {
  using Clock = std::chrono::steady_clock;
  for (int i = 0; i < count; ++i) contender.run(static_cast<std::size_t>(i));
  const auto start = Clock::now();
  int frames = 0;
  double seconds = 0;
  do {
    for (int i = 0; i < count; ++i) contender.run(static_cast<std::size_t>(i));
    frames += count;
    seconds = std::chrono::duration<double>(Clock::now() - start).count();
  } while (seconds < 1e-3);
  return seconds / frames;
}

double median_ratio(const Contender& a, const Contender& b) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < a.seconds.size(); ++i) ratios.push_back(a.seconds[i] / b.seconds[i]);
  return median_of(ratios);
}

enum class Form : std::uint8_t { kText, kMarkdown, kJson };

const char* line_format(Form form) {
  switch (form) {
    case Form::kMarkdown:
      return "| %s | %d x %d | %.1f us | %.3g Gpx/s | %.3g | %.3g |\n";
    case Form::kJson:
      return "{\"name\": \"%s\", \"cols\": %d, \"rows\": %d, \"us_per_frame\": %.3f, "
             "\"gpx_per_s\": %.3f, \"rate_of_plain_read\": %.4f, \"times_opencv_chain\": %.2f}\n";
    case Form::kText:
      break;
  }
  return "%-14s %4d x %4d  %9.2f us  %7.2f Gpx/s  %6.3f of plain read  %6.1f times the OpenCV "
         "chain\n";
}

void print(const Size& size, const std::vector<Contender>& all, Form form) {
  for (const Contender& c : all) {
    const double seconds = median_of(c.seconds);
    const double pixels = static_cast<double>(size.cols) * size.rows;
    const double of_read = median_ratio(all.front(), c);
    const double over_chain = median_ratio(all.back(), c);
    std::printf(line_format(form),
                c.name.c_str(),
                size.cols,
                size.rows,
                1e6 * seconds,
                1e-9 * pixels / seconds,
                of_read,
                over_chain);
  }
  std::fflush(stdout);
}

int run(int rounds, Form form) {
  filter_chain_on_one_thread();
  if (form == Form::kMarkdown) {
    std::printf("| | frame | time | rate | of the plain read | times the OpenCV chain |\n");
    std::printf("|---|---|---|---|---|---|\n");
  }
  for (const Size& size : kSizes) {
    const Frames frames = frames_of(size);
    std::vector<Contender> all = contenders(frames);
    for (int round = 0; round < rounds; ++round) {
      for (Contender& c : all) {
        const double seconds = seconds_per_frame(c, size.frames);
        if (round > 0 || rounds == 1) c.seconds.push_back(seconds);  // the first warms up
      }
    }
    print(size, all, form);
  }
  if (unseen == 0) return 0;
  std::fprintf(stderr, "%zu rows were not seen: the figures would mean little\n", unseen);
  return 1;
}

}  // namespace
}  // namespace facula

int main(int argc, char** argv) {
  int rounds = 200;
  facula::Form form = facula::Form::kText;
  for (int i = 1; i < argc; ++i) {
    const char* end = argv[i] + std::strlen(argv[i]);
    if (std::strcmp(argv[i], "--json") == 0) {
      form = facula::Form::kJson;
    } else if (std::strcmp(argv[i], "--markdown") == 0) {
      form = facula::Form::kMarkdown;
    } else if (std::strcmp(argv[i], "--rounds") == 0 && i + 1 < argc) {
      const char* text = argv[++i];
      end = text + std::strlen(text);
      if (std::from_chars(text, end, rounds).ptr != end || rounds < 1) return 2;
    } else {
      std::fprintf(stderr, "usage: stripe_speed [--rounds N] [--json | --markdown]\n");
      return 2;
    }
  }
  return facula::run(rounds, form);
}
