// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/byte_sequence.hpp>

#include <cstddef>
#include <exception>
#include <functional>
#include <utility>
#include <vector>

namespace facula {

/// A step failed on some rank: thrown on all, so none is left waiting.
class StepFailed : public std::exception {
 public:
  // NOLINTNEXTLINE(bugprone-throw-keyword-missing): the pointer is kept, not thrown
  explicit StepFailed(std::exception_ptr reason) : reason_(std::move(reason)) {}

  /// What was thrown here; null where others failed and this rank did not.
  const std::exception_ptr& reason() const { return reason_; }
  const char* what() const noexcept override { return "a step failed on some rank"; }

 private:
  std::exception_ptr reason_;
};

/// The processes that make a map together (MPI). Every rank calls the same of these functions in
/// the same order, from one thread.
class Ranks {
 public:
  /// Most bytes that one call of MPI moves into or out of a rank: its counts are of 31 bits.
  static constexpr std::size_t kMostAtOnce = std::size_t{1} << 30;

  /// Joins the others; started without mpirun the rank is alone.
  Ranks();
  ~Ranks();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  std::size_t rank() const { return rank_; }                        ///< 0 to size() - 1
  std::size_t size() const { return size_; }                        ///< [1]
  std::size_t on_this_machine() const { return on_this_machine_; }  ///< ranks, this one too [1]
  bool first() const { return rank_ == 0; }

  /// Runs a step of each rank's own and waits for all. Throws StepFailed on all ranks where the
  /// step throws on any.
  void together(const std::function<void()>& step) const;

  /// Hands part i to rank i, and returns what each rank had for this one. Any number of bytes, in
  /// passes of `most_at_once`.
  std::vector<Bytes> exchange(const std::vector<Bytes>& parts,
                              std::size_t most_at_once = kMostAtOnce) const;

  /// Ends all ranks at once with exit code 1: for failures outside together().
  [[noreturn]] static void abort();

 private:
  std::size_t rank_ = 0;
  std::size_t size_ = 1;
  std::size_t on_this_machine_ = 1;
};

}  // namespace facula
