// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace facula {

/// The unit an option is typed in: value in the library's unit = typed number * factor.
struct Unit {
  const char* name = "";
  double factor = 1;
};
inline constexpr Unit kMillimetres{"mm", 1e-3};
inline constexpr Unit kMetres{"m", 1};
inline constexpr Unit kDegrees{"deg", 0.017453292519943295};
inline constexpr Unit kPixels{"px", 1};
inline constexpr Unit kGreyLevels{"DN", 1};
inline constexpr Unit kPlainNumber{"", 1};

/// One option or positional argument of a command, as help shows it and the parser fills it.
struct ArgumentSpec {
  std::string name;          ///< "--voxel-mm", or "SCAN" for a positional one
  std::string also;          ///< another name that is understood; empty when there is none
  std::string value_name;    ///< "MM", "FILE"; empty for a flag
  std::string help;          ///< one sentence
  std::string default_text;  ///< as typed; empty when there is none
  int words = 1;             ///< words it takes, 0 for a flag
  bool repeatable = false;   ///< may be given several times (positional: several words)
  bool required = false;
  std::function<void(const std::vector<std::string>&)> set;  ///< throws UsageError

  bool positional() const { return !name.starts_with("-"); }
};

/// What a command understands. Each call declares one argument, bound to a variable that holds its
/// default and outlives the parsing. Names that begin with "--" are options, others positional.
class Arguments {
 public:
  /// A file or folder to read; "data/..." also finds what the program ships.
  void input(const std::string& name, std::filesystem::path& target, const std::string& help);
  void inputs(const std::string& name,
              std::vector<std::filesystem::path>& target,
              const std::string& help);

  /// A file or folder to write.
  void output(const std::string& name, std::filesystem::path& target, const std::string& help);
  void outputs(const std::string& name,
               std::vector<std::filesystem::path>& target,
               const std::string& help);

  void number(const std::string& name, double& target, Unit unit, const std::string& help);
  void number(const std::string& name,
              std::optional<double>& target,
              Unit unit,
              const std::string& help);
  /// Three numbers, as three words or as one with commas.
  void vector(const std::string& name, Eigen::Vector3d& target, Unit unit, const std::string& help);
  void vector(const std::string& name,
              std::optional<Eigen::Vector3d>& target,
              Unit unit,
              const std::string& help);

  /// Whole numbers, 0 or more.
  void whole(const std::string& name, int& target, const std::string& help);
  void whole(const std::string& name, std::size_t& target, const std::string& help);

  void choice(const std::string& name,
              std::string& target,
              const std::vector<std::string>& allowed,
              const std::string& help);
  /// A word of the user's own, such as a name.
  void word(const std::string& name, std::string& target, const std::string& help);
  void flag(const std::string& name, bool& target, const std::string& help);

  /// The argument declared last must be given.
  void required();

  /// The option declared last is understood by this name too.
  void also(const std::string& name);

  const std::vector<ArgumentSpec>& specs() const { return specs_; }

 private:
  std::vector<ArgumentSpec> specs_;
};

/// Fills the variables from the words after the command's name. Throws UsageError on an unknown
/// option (naming the nearest known one), a missing or a malformed value.
void parse_arguments(const Arguments& arguments, const std::vector<std::string>& words);

}  // namespace facula
