// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <sstream>
#include <stdexcept>

namespace facula {

/// The one exception of the library. what() is one sentence for a person: what was expected, what
/// came, what to do.
class Error : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Throws an Error whose sentence is the parts written one after the other.
template <typename... Parts>
[[noreturn]] void fail(const Parts&... parts) {
  std::ostringstream sentence;
  (sentence << ... << parts);
  throw Error(sentence.str());
}

/// Throws like fail() unless `holds`.
template <typename... Parts>
void require(bool holds, const Parts&... parts) {
  if (!holds) fail(parts...);
}

}  // namespace facula
