// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <exception>
#include <string>

namespace facula {

constexpr int kOk = 0;          ///< exit code: all went well
constexpr int kFailed = 1;      ///< exit code: the work failed
constexpr int kWrongUsage = 2;  ///< exit code: the command line is wrong

/// Writes "who: sentence" as one line on standard error, whatever a library put into the sentence;
/// returns `code`.
int complain(const std::string& who, const std::string& sentence, int code);

/// The same for what was thrown: returns kWrongUsage for a UsageError, else kFailed. Names of the
/// library's types in front of a sentence ("MeshOptions: ") are left out.
int complain(const std::string& who, const std::exception_ptr& thrown);

}  // namespace facula
