// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/parallel.hpp>

#include <atomic>
#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

namespace facula {
namespace {

/// A sum whose rounding depends on the order of its terms.
double delicate_sum(std::size_t count, int threads) {
  return parallel_reduce(
      count,
      0.0,
      [](std::size_t begin, std::size_t end) {
        double sum = 0;
        for (std::size_t i = begin; i < end; ++i) {
          sum += std::sin(static_cast<double>(i)) * 1e10 + 1e-7;
        }
        return sum;
      },
      [](double a, double b) { return a + b; },
      {.num_threads = threads, .chunk = 37});
}

TEST(Parallel, ReducesToTheSameBitsOnEveryNumberOfThreads) {
  const double serial = delicate_sum(10001, 1);
  for (int repeat = 0; repeat < 20; ++repeat) {
    EXPECT_EQ(delicate_sum(10001, 2), serial);
    EXPECT_EQ(delicate_sum(10001, 7), serial);
  }
}

TEST(Parallel, VisitsEveryItemOnce) {
  for (const std::size_t count : {0, 1, 63, 64, 65, 1000}) {
    for (const int threads : {1, 2, 7}) {
      std::vector<std::atomic<int>> visits(count);
      parallel_for(count,
                   [&](std::size_t begin, std::size_t end) {
                     for (std::size_t i = begin; i < end; ++i) ++visits[i];
                   },
                   {.num_threads = threads});
      for (const auto& v : visits) EXPECT_EQ(v, 1);
    }
  }
}

TEST(Parallel, ReducesInOrderFromLeftToRight) {
  const std::string word = parallel_reduce(
      26,
      std::string(">"),
      [](std::size_t begin, std::size_t end) {
        std::string part;
        for (std::size_t i = begin; i < end; ++i) part += static_cast<char>('a' + i);
        return part;
      },
      [](const std::string& a, const std::string& b) { return a + b; },
      {.num_threads = 7, .chunk = 3});
  EXPECT_EQ(word, ">abcdefghijklmnopqrstuvwxyz");
}

TEST(Parallel, ThrowsAgainWhatABodyThrows) {
  for (const int threads : {1, 2, 7}) {
    const auto work = [&] {
      parallel_for(1000,
                   [](std::size_t begin, std::size_t) {
                     if (begin == 640) throw std::runtime_error("chunk 640");
                   },
                   {.num_threads = threads, .chunk = 10});
    };
    EXPECT_THROW(work(), std::runtime_error);
  }
}

TEST(Parallel, UsesAllCoresWhenAskedForNone) {
  EXPECT_GE(thread_count(0), 1);
  EXPECT_EQ(thread_count(5), 5);
}

TEST(Parallel, TakesAChunkOfZeroAsOne) {
  std::atomic<int> calls{0};
  parallel_for(4, [&](std::size_t, std::size_t) { ++calls; }, {.num_threads = 2, .chunk = 0});
  EXPECT_EQ(calls, 4);
}

}  // namespace
}  // namespace facula
