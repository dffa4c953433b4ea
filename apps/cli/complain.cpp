// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/cli/complain.hpp>
#include <facula/apps/cli/usage_error.hpp>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <new>
#include <string_view>

namespace facula {
namespace {

/// "MeshOptions: expected ..." without the type, whose name says nothing to who types options.
std::string without_type(const std::string& sentence) {
  constexpr std::string_view kEnd = "Options: ";
  const std::size_t at = sentence.find(kEnd);
  const bool leads = at != std::string::npos && sentence.find(' ') > at;
  return leads ? sentence.substr(at + kEnd.size()) : sentence;
}

}  // namespace

int complain(const std::string& who, const std::string& sentence, int code) {
  std::string line = sentence;
  std::replace(line.begin(), line.end(), '\n', ' ');
  while (line.ends_with(' ')) line.pop_back();
  std::cerr << (who + ": " + line + "\n") << std::flush;
  return code;
}

int complain(const std::string& who, const std::exception_ptr& thrown) {
  try {
    std::rethrow_exception(thrown);
  } catch (const UsageError& error) {
    return complain(who, error.what(), kWrongUsage);
  } catch (const std::bad_alloc&) {
    return complain(who,
                    "expected enough memory, got none left; take fewer points (a larger voxel or "
                    "cell, fewer scans) or a larger machine",
                    kFailed);
  } catch (const std::filesystem::filesystem_error& error) {
    return complain(who,
                    "expected a usable path, got '" + error.path1().string() +
                        "': " + error.code().message() + "; check the path and its permissions",
                    kFailed);
  } catch (const std::exception& error) {
    return complain(who, without_type(error.what()), kFailed);
  }
}

}  // namespace facula
