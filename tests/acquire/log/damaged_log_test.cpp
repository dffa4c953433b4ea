// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/random.hpp>
#include <facula/acquire/core/whole_file.hpp>
#include <facula/tests/acquire/log/logged_wall.hpp>
#include <facula/tests/support/matchers.hpp>

#include <fstream>

namespace facula {
namespace {

class DamagedLog : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared_folder = new TemporaryFolder;
    const Capture capture = logged_wall(*shared_folder / "run", 5);
    whole_scan = new PolarScan(
        extract_scan(capture, {.num_threads = 1, .log = *shared_folder / "scan.flog"}).scan);
    recorded = new std::string(read_whole_file(*shared_folder / "scan.flog"));
  }

  static void TearDownTestSuite() {
    delete recorded;
    delete whole_scan;
    delete shared_folder;
  }

  static std::filesystem::path write(const std::string& bytes) {
    return shared_folder->write("damaged.flog", bytes);
  }

  static std::string complaint(const std::string& bytes) {
    const auto path = write(bytes);
    return error_of([&] { const StripeLogReader log(path); });
  }

  /// Every column that is not empty equals the true one.
  static testing::AssertionResult holds_true_columns(const PolarScan& scan) {
    if (scan.rows != whole_scan->rows || scan.cols > whole_scan->cols) {
      return testing::AssertionFailure() << "the scan is of another size";
    }
    for (int col = 0; col < scan.cols; ++col) {
      const std::size_t first = scan.index(0, col);
      const auto column = [&](const std::vector<float>& values) {
        return std::vector<float>(values.begin() + static_cast<long>(first),
                                  values.begin() + static_cast<long>(first) + scan.rows);
      };
      const std::vector<float> range = column(scan.range);
      const bool empty = std::all_of(range.begin(), range.end(), [](float r) { return r == 0; });
      if (empty) continue;
      if (range != column(whole_scan->range) || column(scan.sigma) != column(whole_scan->sigma) ||
          scan.axis_position[static_cast<std::size_t>(col)] !=
              whole_scan->axis_position[static_cast<std::size_t>(col)]) {
        return testing::AssertionFailure() << "column " << col << " is another";
      }
    }
    return testing::AssertionSuccess();
  }

  static TemporaryFolder* shared_folder;
  static PolarScan* whole_scan;
  static std::string* recorded;
};

TemporaryFolder* DamagedLog::shared_folder = nullptr;
PolarScan* DamagedLog::whole_scan = nullptr;
std::string* DamagedLog::recorded = nullptr;

TEST_F(DamagedLog, IsCalledByWhatIsWrongWithIt) {
  EXPECT_NE(complaint("").find("no stripe log"), std::string::npos);
  EXPECT_NE(complaint("# .PCD v0.7").find("no stripe log"), std::string::npos);
  EXPECT_NE(complaint(recorded->substr(0, 30)).find("ends within its header"), std::string::npos);
  EXPECT_NE(complaint(recorded->substr(0, 200)).find("ends within its header"), std::string::npos);
  std::string other = *recorded;
  other[8] = 9;
  EXPECT_NE(complaint(other).find("version 9"), std::string::npos);
  other = *recorded;
  other[100] = static_cast<char>(other[100] ^ 1);
  EXPECT_NE(complaint(other).find("checksum differs"), std::string::npos);
  EXPECT_NE(error_of([] { const StripeLogReader log("nowhere.flog"); }).find("no such file"),
            std::string::npos);
}

TEST_F(DamagedLog, WithoutAnyRecordSaysThatNothingWasRecorded) {
  const StripeLogReader whole(*shared_folder / "scan.flog");
  const std::size_t header = recorded->size() - (whole.bytes() - 64 - whole.header().rig.size() -
                                                 whole.header().settings.size());
  const StripeLogReader log(write(recorded->substr(0, header)));
  EXPECT_EQ(log.size(), 0U);
  EXPECT_NE(error_of([&] { extract_scan(log, log.settings()); }).find("no whole frame yet"),
            std::string::npos);
}

TEST_F(DamagedLog, WithATornTailLosesTheLastFrameAndSaysSo) {
  const StripeLogReader log(write(recorded->substr(0, recorded->size() - 1)));
  EXPECT_EQ(log.size(), 4U);
  EXPECT_GT(log.damage().torn_bytes, 1000U);
  EXPECT_EQ(log.damage().dropped_records, 0U);
  const ExtractResult result = extract_scan(log, log.settings());
  EXPECT_EQ(result.scan.cols, 4);
  EXPECT_EQ(result.log->torn_bytes, log.damage().torn_bytes);
  EXPECT_TRUE(holds_true_columns(result.scan));
}

TEST_F(DamagedLog, FindsTheNextRecordBehindADamagedHead) {
  const StripeLogReader whole(*shared_folder / "scan.flog");
  const std::size_t header = 64 + whole.header().rig.size() + whole.header().settings.size();
  for (const std::size_t byte : {0U, 9U, 17U, 25U}) {
    std::string bytes = *recorded;
    bytes[header + byte] = static_cast<char>(bytes[header + byte] ^ 0x40);
    const StripeLogReader log(write(bytes));
    EXPECT_EQ(log.size(), 4U) << byte;
    EXPECT_EQ(log.damage().dropped_records, 1U) << byte;
    EXPECT_TRUE(holds_true_columns(extract_scan(log, log.settings()).scan)) << byte;
  }
}

/// Flips, cuts, zeroed and doubled stretches: an error in one sentence, or true columns and every
/// lost frame accounted for.
TEST_F(DamagedLog, NeverGivesAWrongColumnNorCrashes) {
  Random random(7, 0);
  const auto below = [&](std::size_t n) {
    return std::min(n - 1, static_cast<std::size_t>(random.uniform() * static_cast<double>(n)));
  };
  int refused = 0;
  int read = 0;
  for (int round = 0; round < 600; ++round) {
    std::string bytes = *recorded;
    bool cut = false;
    for (std::size_t change = 0; change <= below(3); ++change) {
      const std::size_t at = below(bytes.size());
      const std::size_t length = std::min(bytes.size() - at, 1 + below(3000));
      switch (below(5)) {
        case 0:
        case 1:
          bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
          break;
        case 2:
          bytes.resize(at + 1);
          cut = true;
          break;
        case 3:
          std::fill_n(bytes.begin() + static_cast<long>(at), length, '\0');
          break;
        default:
          bytes.insert(at, bytes.substr(at, length));
      }
    }
    const auto path = write(bytes);
    try {
      const StripeLogReader log(path);
      const ExtractResult result = extract_scan(log, log.settings(), {.num_threads = 1});
      ++read;
      EXPECT_TRUE(holds_true_columns(result.scan)) << "round " << round;
      const bool lost = result.frames < 5;
      // Only a cut can fall between two records and leave no trace but the number of frames.
      const bool said = result.log->dropped_records > 0 || result.log->torn_bytes > 0 || cut;
      EXPECT_TRUE(!lost || said) << "round " << round;
    } catch (const Error& error) {
      ++refused;
      EXPECT_GT(std::string(error.what()).size(), 20U);
    }
  }
  EXPECT_GT(read, 200);
  EXPECT_GT(refused, 20);
}

}  // namespace
}  // namespace facula
