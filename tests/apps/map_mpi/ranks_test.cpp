// SPDX-License-Identifier: GPL-3.0-or-later
// Runs on every rank that mpirun starts; alone without it.
#include <facula/apps/map_mpi/ranks.hpp>

#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

namespace facula {
namespace {

/// MPI can be joined once in a process.
const Ranks& ranks() {
  static const Ranks joined;
  return joined;
}

/// What one rank has for another: of another length for each pair, sometimes nothing.
Bytes part_between(std::size_t from, std::size_t to) {
  Bytes part;
  for (std::size_t i = 0; i < 37 * ((3 * from + 5 * to) % 7); ++i) {
    part.push_back(static_cast<std::uint8_t>(from + 16 * to + 31 * i));
  }
  return part;
}

TEST(Ranks, HandEveryOtherItsPartWhateverFitsIntoOnePass) {
  std::vector<Bytes> parts;
  for (std::size_t to = 0; to < ranks().size(); ++to) {
    parts.push_back(part_between(ranks().rank(), to));
  }
  for (const std::size_t most : {Ranks::kMostAtOnce, std::size_t{100}, std::size_t{1}}) {
    const std::vector<Bytes> received = ranks().exchange(parts, most);
    ASSERT_EQ(received.size(), ranks().size());
    for (std::size_t from = 0; from < ranks().size(); ++from) {
      EXPECT_EQ(received[from], part_between(from, ranks().rank())) << from << " " << most;
    }
  }
}

TEST(Ranks, AllLearnThatAStepFailedOnOne) {
  const std::size_t last = ranks().size() - 1;
  bool failed = false;
  try {
    ranks().together([&] {
      if (ranks().rank() == last) throw std::runtime_error("no disk");
    });
  } catch (const StepFailed& failure) {
    failed = true;
    EXPECT_EQ(static_cast<bool>(failure.reason()), ranks().rank() == last);
  }
  EXPECT_TRUE(failed);
  int steps = 0;
  ranks().together([&] { ++steps; });
  EXPECT_EQ(steps, 1);
}

TEST(Ranks, KnowWhoSharesTheirMachine) {
  EXPECT_EQ(ranks().on_this_machine(), ranks().size());
  EXPECT_LT(ranks().rank(), ranks().size());
}

}  // namespace
}  // namespace facula
