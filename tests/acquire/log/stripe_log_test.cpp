// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/capture/frame_source.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/acquire/log/log_settings.hpp>
#include <facula/acquire/log/stripe_log_writer.hpp>
#include <facula/acquire/rig/rig_file.hpp>
#include <facula/tests/acquire/log/logged_wall.hpp>
#include <facula/tests/support/matchers.hpp>

#include <atomic>
#include <fstream>
#include <thread>

namespace facula {
namespace {

class StripeLog : public testing::Test {
 protected:
  ExtractResult extract(const Capture& capture, bool resume = false) const {
    return extract_scan(capture, {.log = folder_ / "scan.flog", .resume = resume});
  }

  TemporaryFolder folder_;
};

TEST_F(StripeLog, GivesTheScanBitForBit) {
  for (const bool background : {false, true}) {
    const Capture capture =
        logged_wall(folder_ / ("run" + std::to_string(background)), 8, background);
    std::filesystem::remove(folder_ / "scan.flog");
    const ExtractResult whole = extract_scan(capture);
    const ExtractResult logged = extract(capture);
    ASSERT_GT(whole.scan.valid_count(), 700U);
    EXPECT_TRUE(is_same_scan(logged.scan, whole.scan)) << "while logging";
    std::filesystem::remove_all(folder_ / ("run" + std::to_string(background)));
    const StripeLogReader log(folder_ / "scan.flog");
    for (const int threads : {1, 3}) {
      const ExtractResult again = extract_scan(log, log.settings(), {.num_threads = threads});
      EXPECT_TRUE(is_same_scan(again.scan, logged.scan)) << "from the log alone";
      EXPECT_EQ(again.stripes_seen, logged.stripes_seen);
      EXPECT_EQ(again.median_noise, logged.median_noise);
      EXPECT_EQ(again.median_pixel_sigma, logged.median_pixel_sigma);
    }
  }
}

TEST_F(StripeLog, KeepsAStripePerColumnAndACommonBackground) {
  Rig rig = small_head();
  std::swap(rig.camera.width, rig.camera.height);
  std::swap(rig.camera.cx, rig.camera.cy);
  std::swap(rig.lasers[0].normal.x(), rig.lasers[0].normal.y());
  rig.stripe_direction = StripeDirection::kPerColumn;
  SimulatedRun run;
  run.positions.assign(6, 0.0);
  SimulateOptions options = options_for(rig);
  options.background_frames = true;
  simulate_capture(folder_ / "run", scene_with({wall_at(2)}), rig, run, options);
  Capture capture = read_capture(folder_ / "run");
  capture.background.resize(1);
  const ExtractResult whole = extract_scan(capture);
  const ExtractResult logged = extract(capture);
  ASSERT_GT(whole.scan.valid_count(), 600U);
  EXPECT_TRUE(is_same_scan(logged.scan, whole.scan));
  const StripeLogReader log(folder_ / "scan.flog");
  EXPECT_EQ(log.header().background, LoggedBackground::kCommon);
  EXPECT_TRUE(is_same_scan(extract_scan(log, log.settings()).scan, logged.scan));
}

TEST_F(StripeLog, KeepsTheBareBedOfAZeroLine) {
  Capture capture = logged_wall(folder_ / "run", 5);
  const Capture bed = logged_wall(folder_ / "bed", 5);
  capture.zero_line = ZeroLine{bed.frames, {{0, 119}}, 119.0};
  const ExtractResult whole = extract_scan(capture);
  const ExtractResult logged = extract(capture);
  EXPECT_TRUE(is_same_scan(logged.scan, whole.scan));
  const StripeLogReader log(folder_ / "scan.flog");
  const ExtractResult again = extract_scan(log, log.settings());
  EXPECT_TRUE(is_same_scan(again.scan, whole.scan));
  EXPECT_EQ(again.zero_line_shift, whole.zero_line_shift);
}

/// Two exposures at every position, each lit, dark, lit: a log keeps what they were merged from.
TEST_F(StripeLog, KeepsEveryExposureOfABracket) {
  const Capture single = logged_wall(folder_ / "run", 12, true);
  Capture capture = single;
  capture.frames.clear();
  capture.background.clear();
  for (std::size_t i = 0; i < 12; i += 2) {
    for (const std::size_t exposure : {i, i + 1}) {
      capture.frames.push_back(single.frames[exposure]);
      capture.frames.push_back(single.background[exposure]);
      capture.frames.push_back(single.frames[exposure]);
    }
  }
  capture.alternation = Alternation::kOnOffOn;
  capture.exposures = {5.0, 2.5};
  capture.positions.resize(6);
  const ExtractResult whole = extract_scan(capture);
  const ExtractResult logged = extract(capture);
  ASSERT_GT(whole.scan.valid_count(), 500U);
  EXPECT_TRUE(is_same_scan(logged.scan, whole.scan));
  const StripeLogReader log(folder_ / "scan.flog");
  EXPECT_EQ(log.header().exposures, 2);
  EXPECT_TRUE(is_same_scan(extract_scan(log, log.settings()).scan, logged.scan));
}

/// A rig made in memory has no file whose bytes could be kept; its numbers survive as text.
TEST_F(StripeLog, ComputesTheScanFromTheRigItStores) {
  Capture capture = logged_wall(folder_ / "run", 3);
  capture.rig.lasers[0].distance *= 1 + 1e-15;
  capture.rig.lasers[0].bow = 0.01 / 3;
  capture.world_from_scan.rotation = Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized());
  const ExtractResult logged = extract(capture);
  const StripeLogReader log(folder_ / "scan.flog");
  EXPECT_TRUE(is_same_scan(extract_scan(log, log.settings()).scan, logged.scan));
}

TEST_F(StripeLog, RecomputesWithANewerRig) {
  const Capture capture = logged_wall(folder_ / "run", 4);
  extract(capture);
  Rig newer = capture.rig;
  newer.lasers[0].distance *= 1.01;
  newer.camera.k1 = -0.19;
  write_rig(folder_ / "newer.toml", newer);
  const StripeLogReader log(folder_ / "scan.flog");
  const Capture renewed = with_rig(log.settings(), folder_ / "newer.toml");
  const PolarScan from_log = extract_scan(log, renewed).scan;
  EXPECT_TRUE(is_same_scan(from_log, extract_scan(with_rig(capture, folder_ / "newer.toml")).scan));
  EXPECT_FALSE(is_same_scan(from_log, extract_scan(capture).scan));
}

/// Centroids read their background over the whole row, which a log does not have; the positions
/// agree within a fraction of their sigma.
TEST_F(StripeLog, RecomputesWithAnotherDetector) {
  Capture capture = logged_wall(folder_ / "run", 6);
  extract(capture);
  const StripeLogReader log(folder_ / "scan.flog");
  Capture settings = log.settings();
  settings.stripe.detector = capture.stripe.detector = DetectorKind::kCentroid;
  const PolarScan from_log = extract_scan(log, settings).scan;
  const PolarScan from_frames = extract_scan(capture).scan;
  std::size_t both = 0;
  std::size_t near = 0;
  for (std::size_t i = 0; i < from_log.valid.size(); ++i) {
    if (from_log.valid[i] == 0 || from_frames.valid[i] == 0) continue;
    ++both;
    near += std::abs(from_log.range[i] - from_frames.range[i]) < from_frames.sigma[i] ? 1U : 0U;
  }
  EXPECT_GT(both, 500U);
  EXPECT_GT(static_cast<double>(near), 0.98 * static_cast<double>(both));
}

TEST_F(StripeLog, FindsTheStripeAgainForAnotherChannelOrWidth) {
  Capture capture = logged_wall(folder_ / "run", 6);
  extract(capture);
  const StripeLogReader log(folder_ / "scan.flog");
  Capture settings = log.settings();
  settings.stripe.sigma = capture.stripe.sigma = 1.5;
  settings.stripe.channel = capture.stripe.channel = Channel::kMaximum;
  const double from_frames = static_cast<double>(extract_scan(capture).scan.valid_count());
  const double from_log = static_cast<double>(extract_scan(log, settings).scan.valid_count());
  EXPECT_GT(from_frames, 500);
  EXPECT_NEAR(from_log, from_frames, 0.02 * from_frames);
}

TEST_F(StripeLog, ResumesOnlyWhatIsMissing) {
  const Capture capture = logged_wall(folder_ / "run", 9);
  const ExtractResult whole = extract(capture);
  const std::uint64_t record =
      (whole.log->bytes - StripeLogReader(folder_ / "scan.flog").header().rig.size()) / 9;
  std::filesystem::resize_file(folder_ / "scan.flog", whole.log->bytes - 2 * record);
  const ExtractResult resumed = extract(capture, true);
  EXPECT_GE(resumed.log->appended, 2U);
  EXPECT_LE(resumed.log->appended, 3U);
  EXPECT_GT(resumed.log->torn_bytes, 0U);
  EXPECT_TRUE(is_same_scan(resumed.scan, whole.scan));
  const ExtractResult again = extract(capture, true);
  EXPECT_EQ(again.log->appended, 0U);
  EXPECT_EQ(again.log->torn_bytes, 0U);
  EXPECT_TRUE(is_same_scan(again.scan, whole.scan));
}

TEST_F(StripeLog, IsNotOverwrittenNorContinuedByAnotherRecording) {
  const Capture capture = logged_wall(folder_ / "run", 3);
  extract(capture);
  const auto refused = [&](const Capture& other, bool resume) {
    return error_of([&] { extract(other, resume); });
  };
  EXPECT_NE(refused(capture, false).find("--resume"), std::string::npos);
  Capture other = capture;
  other.rig.lasers[0].distance *= 1.1;
  EXPECT_NE(refused(other, true).find("another rig"), std::string::npos);
  other = capture;
  other.stripe.min_snr = 6;
  EXPECT_NE(refused(other, true).find("other settings"), std::string::npos);
  other = capture;
  other.positions[1] += 0.001;
  EXPECT_NE(refused(other, true).find("another axis position"), std::string::npos);
  other = capture;
  other.positions.pop_back();
  other.frames.pop_back();
  EXPECT_NE(refused(other, true).find("3 frames, and this capture has 2"), std::string::npos);
}

/// A log that is replaced while it is written goes on without a name, and its frames are lost.
TEST_F(StripeLog, IsBegunByOneOfManyAtTheSameTime) {
  Capture capture;
  capture.rig = small_head();
  capture.positions = {0.0};
  const StripeLogHeader header = header_of(capture, 1);
  for (int round = 0; round < 10; ++round) {
    const auto path = folder_ / ("log" + std::to_string(round));
    std::atomic<int> begun{0};
    std::atomic<int> refused{0};
    std::vector<std::thread> programs;
    for (int i = 0; i < 6; ++i) {
      programs.emplace_back([&] {
        try {
          const auto writer = StripeLogWriter::create(path, header, {});
          ++begun;
        } catch (const Error&) {
          ++refused;
        }
      });
    }
    for (std::thread& program : programs) program.join();
    EXPECT_EQ(begun, 1);
    EXPECT_EQ(refused, 5);
  }
}

/// As many as capture.toml may name.
TEST_F(StripeLog, HoldsSixteenExposures) {
  Capture capture;
  capture.rig = small_head();
  capture.positions = {0.0};
  capture.exposures.assign(16, 1.0);
  const StripeLogHeader header = header_of(capture, 1);
  EXPECT_EQ(decode_header(encode_header(header), "log").exposures, 16);
  capture.exposures.push_back(1.0);
  EXPECT_NE(error_of([&] { encode_header(header_of(capture, 1)); }).find("17 exposures"),
            std::string::npos);
}

/// Grey frames of 640 x 480 with the stripe in every row.
TEST_F(StripeLog, TakesAtMostTwelvePercentOfTheRawFrames) {
  for (const int channels : {1, 3}) {
    Capture capture;
    capture.rig = small_head();
    capture.rig.camera = {
        .width = 640, .height = 480, .fx = 800, .fy = 800, .cx = 319.5, .cy = 239.5};
    for (int f = 0; f < 4; ++f) {
      Image8 frame(480, 640, channels);
      for (int r = 0; r < 480; ++r) {
        for (int c = 0; c < 640; ++c) {
          const double u = (c - 300 - 0.2 * r - 5 * f) / 2.0;
          const auto value = static_cast<std::uint8_t>(8 + 120 * std::exp(-0.5 * u * u));
          frame.row(r)[c * channels + channels - 1] = value;
        }
      }
      capture.frames.push_back(folder_ / ("f" + std::to_string(f) + ".png"));
      write_image(capture.frames.back(), frame.view());
      capture.positions.push_back(0);
    }
    std::filesystem::remove(folder_ / "scan.flog");
    const ExtractResult result = extract(capture);
    ASSERT_GT(result.stripes_seen, 4U * 470U);
    EXPECT_TRUE(is_same_scan(result.scan, extract_scan(capture).scan)) << channels;
    EXPECT_EQ(result.log->raw_bytes, 4U * 640U * 480U * static_cast<unsigned>(channels));
    EXPECT_LE(static_cast<double>(result.log->bytes),
              0.12 * static_cast<double>(result.log->raw_bytes));
    EXPECT_EQ(result.log->bytes, std::filesystem::file_size(folder_ / "scan.flog"));
  }
}

TEST_F(StripeLog, LeavesColumnsOfUnrecordedFramesEmptyWithPlausiblePositions) {
  const Capture capture = logged_wall(folder_ / "run", 5);
  extract(capture);
  const StripeLogReader before(folder_ / "scan.flog");
  // A byte amid the third record.
  const auto at = static_cast<std::streamoff>(before.bytes() * 55 / 100);
  std::fstream file(folder_ / "scan.flog", std::ios::in | std::ios::out | std::ios::binary);
  file.seekg(at);
  const int byte = file.get();
  file.seekp(at);
  file.put(static_cast<char>(byte ^ 16));
  file.close();
  const StripeLogReader log(folder_ / "scan.flog");
  const ExtractResult result = extract_scan(log, log.settings());
  EXPECT_EQ(result.log->dropped_records, 1U);
  EXPECT_EQ(result.frames, 4U);
  ASSERT_EQ(result.scan.cols, 5);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_NEAR(result.scan.axis_position[i], capture.positions[i], 1e-9);
  }
  // What the images are still there for is measured again.
  const ExtractResult repaired = extract(capture, true);
  EXPECT_EQ(repaired.log->dropped_records, 1U);
  EXPECT_EQ(repaired.log->appended, 1U);
  EXPECT_TRUE(is_same_scan(repaired.scan, extract_scan(capture).scan));
}

}  // namespace
}  // namespace facula
