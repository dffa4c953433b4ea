// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/nearest_name.hpp>
#include <facula/acquire/core/text_numbers.hpp>
#include <facula/apps/cli/arguments.hpp>
#include <facula/apps/cli/data_folder.hpp>
#include <facula/apps/cli/number_text.hpp>
#include <facula/apps/cli/usage_error.hpp>

#include <cmath>
#include <limits>

namespace facula {
namespace {

using Words = std::vector<std::string>;

double parsed_number(const std::string& name, const std::string& word, Unit unit) {
  const std::optional<double> value = parse_number<double>(word);
  if (!value || !std::isfinite(*value)) {
    fail_usage(name,
               ": expected a number",
               *unit.name != 0 ? " in " : "",
               unit.name,
               ", got '",
               word,
               "'; write for instance 12.5");
  }
  return *value * unit.factor;
}

Eigen::Vector3d parsed_vector(const std::string& name, const Words& words, Unit unit) {
  if (words.size() != 3) {
    fail_usage(
        name, ": expected three numbers, got ", words.size(), "; write for instance 1 2 0.5");
  }
  return {parsed_number(name, words[0], unit),
          parsed_number(name, words[1], unit),
          parsed_number(name, words[2], unit)};
}

long long parsed_whole(const std::string& name, const std::string& word, long long largest) {
  const std::optional<long long> value = parse_number<long long>(word);
  if (!value || *value < 0 || *value > largest) {
    fail_usage(name,
               ": expected a whole number from 0 to ",
               largest,
               ", got '",
               word,
               "'; write for instance 3");
  }
  return *value;
}

std::filesystem::path parsed_path(const std::string& name, const std::string& word) {
  if (word.empty()) fail_usage(name, ": expected a path, got an empty word; write one");
  return word;
}

std::string typed_in(double value, Unit unit) {
  // Nine digits hide the rounding of the unit's factor: 0.02 m is shown as 20 mm.
  const double typed = value / unit.factor;
  std::string text = fixed_text(typed, 9);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.ends_with('.')) text.pop_back();
  return text;
}

std::string value_name(Unit unit) {
  std::string name = *unit.name != 0 ? unit.name : "number";
  for (char& letter : name) {
    if (letter >= 'a' && letter <= 'z') letter = static_cast<char>(letter - 'a' + 'A');
  }
  return name;
}

ArgumentSpec spec(const std::string& name,
                  const std::string& value_name,
                  const std::string& help,
                  const std::string& default_text = {}) {
  ArgumentSpec made;
  made.name = name;
  made.value_name = value_name;
  made.help = help;
  made.default_text = default_text;
  return made;
}

}  // namespace

void Arguments::input(const std::string& name,
                      std::filesystem::path& target,
                      const std::string& help) {
  specs_.push_back(spec(name, "PATH", help));
  specs_.back().set = [&target, name](const Words& words) {
    target = resolved_input(parsed_path(name, words.front()));
  };
}

void Arguments::inputs(const std::string& name,
                       std::vector<std::filesystem::path>& target,
                       const std::string& help) {
  specs_.push_back(spec(name, "PATH", help));
  specs_.back().repeatable = true;
  specs_.back().set = [&target, name](const Words& words) {
    for (const std::string& word : words) target.push_back(resolved_input(parsed_path(name, word)));
  };
}

void Arguments::output(const std::string& name,
                       std::filesystem::path& target,
                       const std::string& help) {
  specs_.push_back(spec(name, "PATH", help, target.string()));
  specs_.back().set = [&target, name](const Words& words) {
    target = parsed_path(name, words.front());
  };
}

void Arguments::outputs(const std::string& name,
                        std::vector<std::filesystem::path>& target,
                        const std::string& help) {
  specs_.push_back(spec(name, "PATH", help));
  specs_.back().repeatable = true;
  specs_.back().set = [&target, name](const Words& words) {
    for (const std::string& word : words) target.push_back(parsed_path(name, word));
  };
}

void Arguments::number(const std::string& name,
                       double& target,
                       Unit unit,
                       const std::string& help) {
  specs_.push_back(spec(name, value_name(unit), help, typed_in(target, unit)));
  specs_.back().set = [&target, name, unit](const Words& words) {
    target = parsed_number(name, words.front(), unit);
  };
}

void Arguments::number(const std::string& name,
                       std::optional<double>& target,
                       Unit unit,
                       const std::string& help) {
  specs_.push_back(spec(name, value_name(unit), help));
  if (target) specs_.back().default_text = typed_in(*target, unit);
  specs_.back().set = [&target, name, unit](const Words& words) {
    target = parsed_number(name, words.front(), unit);
  };
}

void Arguments::vector(const std::string& name,
                       Eigen::Vector3d& target,
                       Unit unit,
                       const std::string& help) {
  specs_.push_back(spec(name,
                        "X Y Z",
                        help,
                        typed_in(target.x(), unit) + " " + typed_in(target.y(), unit) + " " +
                            typed_in(target.z(), unit)));
  specs_.back().words = 3;
  specs_.back().set = [&target, name, unit](const Words& words) {
    target = parsed_vector(name, words, unit);
  };
}

void Arguments::vector(const std::string& name,
                       std::optional<Eigen::Vector3d>& target,
                       Unit unit,
                       const std::string& help) {
  specs_.push_back(spec(name, "X Y Z", help));
  specs_.back().words = 3;
  specs_.back().set = [&target, name, unit](const Words& words) {
    target = parsed_vector(name, words, unit);
  };
}

void Arguments::whole(const std::string& name, int& target, const std::string& help) {
  specs_.push_back(spec(name, "N", help, std::to_string(target)));
  specs_.back().set = [&target, name](const Words& words) {
    target = static_cast<int>(parsed_whole(name, words.front(), std::numeric_limits<int>::max()));
  };
}

void Arguments::whole(const std::string& name, std::size_t& target, const std::string& help) {
  specs_.push_back(spec(name, "N", help, std::to_string(target)));
  specs_.back().set = [&target, name](const Words& words) {
    target = static_cast<std::size_t>(
        parsed_whole(name, words.front(), std::numeric_limits<long long>::max()));
  };
}

void Arguments::choice(const std::string& name,
                       std::string& target,
                       const std::vector<std::string>& allowed,
                       const std::string& help) {
  std::string names;
  for (const std::string& word : allowed) names += (names.empty() ? "" : "|") + word;
  specs_.push_back(spec(name, names, help, target));
  specs_.back().set = [&target, name, allowed, names](const Words& words) {
    for (const std::string& word : allowed) {
      if (word == words.front()) {
        target = word;
        return;
      }
    }
    const std::string near = nearest_name(words.front(), allowed);
    fail_usage(name,
               ": expected one of ",
               names,
               ", got '",
               words.front(),
               "'; ",
               near.empty() ? "choose one of these" : "did you mean '" + near + "'?");
  };
}

void Arguments::word(const std::string& name, std::string& target, const std::string& help) {
  specs_.push_back(spec(name, "NAME", help, target));
  specs_.back().set = [&target, name](const Words& words) {
    if (words.front().empty()) fail_usage(name, ": expected a name, got an empty word; write one");
    target = words.front();
  };
}

void Arguments::flag(const std::string& name, bool& target, const std::string& help) {
  specs_.push_back(spec(name, "", help));
  specs_.back().words = 0;
  specs_.back().set = [&target](const Words&) { target = true; };
}

void Arguments::required() {
  specs_.back().required = true;
}

void Arguments::also(const std::string& name) {
  specs_.back().also = name;
}

}  // namespace facula
