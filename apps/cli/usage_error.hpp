// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/error.hpp>

namespace facula {

/// The command line itself is wrong: the program ends with 2 instead of 1.
class UsageError : public Error {
  using Error::Error;
};

/// Throws a UsageError whose sentence is the parts written one after the other.
template <typename... Parts>
[[noreturn]] void fail_usage(const Parts&... parts) {
  std::ostringstream sentence;
  (sentence << ... << parts);
  throw UsageError(sentence.str());
}

}  // namespace facula
