// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/nearest_name.hpp>
#include <facula/apps/cli/arguments.hpp>
#include <facula/apps/cli/usage_error.hpp>

#include <algorithm>
#include <utility>

#include <CLI/CLI.hpp>

namespace facula {
namespace {

std::vector<std::string> option_names(const Arguments& arguments) {
  std::vector<std::string> names;
  for (const ArgumentSpec& spec : arguments.specs()) {
    if (!spec.positional()) names.push_back(spec.name);
  }
  return names;
}

const ArgumentSpec* option_called(const Arguments& arguments, const std::string& name) {
  for (const ArgumentSpec& spec : arguments.specs()) {
    if (!spec.positional() && (spec.name == name || spec.also == name)) return &spec;
  }
  return nullptr;
}

/// "1,2,3" as three words; other words stay as they are.
std::vector<std::string> split_at_commas(const std::string& word) {
  if (std::count(word.begin(), word.end(), ',') != 2) return {word};
  const std::size_t first = word.find(',');
  const std::size_t second = word.find(',', first + 1);
  return {
      word.substr(0, first), word.substr(first + 1, second - first - 1), word.substr(second + 1)};
}

/// The words with every option by its own name, and vectors as three words.
std::vector<std::string> plain_words(const Arguments& arguments,
                                     const std::vector<std::string>& words) {
  std::vector<std::string> plain;
  const ArgumentSpec* before = nullptr;  // the option that the word stands right behind
  const auto add_parts = [&](const std::string& word) {
    for (std::string& part : split_at_commas(word)) plain.push_back(std::move(part));
  };
  for (const std::string& word : words) {
    const bool behind_vector = before != nullptr && before->words == 3;
    const std::size_t equals = word.find('=');
    const std::string name = word.substr(0, equals);
    before = word.starts_with("--") ? option_called(arguments, name) : nullptr;
    if (before == nullptr && behind_vector) {
      add_parts(word);
    } else if (before == nullptr) {
      plain.push_back(word);
    } else if (equals == std::string::npos) {
      plain.push_back(before->name);
    } else if (before->words == 3) {
      plain.push_back(before->name);
      add_parts(word.substr(equals + 1));
      before = nullptr;
    } else {
      plain.push_back(before->name + word.substr(equals));
    }
  }
  return plain;
}

/// Said before anything else, since a mistyped option also makes others look missing.
void check_option_names(const Arguments& arguments, const std::vector<std::string>& words) {
  const std::vector<std::string> known = option_names(arguments);
  for (const std::string& word : words) {
    if (!word.starts_with("--")) continue;
    const std::string name = word.substr(0, word.find('='));
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    const std::string near = nearest_name(name, known);
    fail_usage("expected one of its options, got '",
               name,
               "'; ",
               near.empty() ? "see --help for all of them" : "did you mean '" + near + "'?");
  }
}

/// The argument that a message of CLI11 is about: it begins with its name.
std::string first_word(const std::string& message) {
  return message.substr(0, message.find_first_of(" :"));
}

/// One argument for CLI11; it splits the words, their meaning is ours.
void declare(CLI::App& app, const ArgumentSpec& spec) {
  if (spec.words == 0) {
    app.add_flag_callback(spec.name, [&spec] { spec.set({}); });
    return;
  }
  auto* option = app.add_option_function<std::vector<std::string>>(
      spec.name, [&spec](const std::vector<std::string>& words) { spec.set(words); });
  if (spec.repeatable && spec.positional()) {
    option->expected(1, 1 << 20);
  } else if (spec.repeatable) {
    option->expected(1)->take_all()->allow_extra_args(false);
  } else if (spec.positional()) {
    option->expected(spec.words);
  } else {
    option->expected(spec.words)->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  }
  if (spec.required) option->required();
}

}  // namespace

void parse_arguments(const Arguments& arguments, const std::vector<std::string>& words) {
  const std::vector<std::string> plain = plain_words(arguments, words);
  check_option_names(arguments, plain);
  CLI::App app;
  app.set_help_flag();
  for (const ArgumentSpec& spec : arguments.specs()) declare(app, spec);
  std::vector<std::string> reversed(plain.rbegin(), plain.rend());
  std::replace(reversed.begin(), reversed.end(), std::string("-o"), std::string("--out"));
  try {
    app.parse(reversed);
  } catch (const CLI::RequiredError& error) {
    fail_usage("expected ", first_word(error.what()), ", got none; give it, or see --help");
  } catch (const CLI::ArgumentMismatch& error) {
    const std::string name = first_word(error.what());
    if (!name.starts_with("-")) fail_usage("expected one ", name, ", got more words; see --help");
    fail_usage("expected a value behind ",
               name,
               " (as many as --help says), got none or too few; give it, or see --help");
  } catch (const CLI::ExtrasError&) {
    fail_usage("expected nothing more, got '", app.remaining().front(), "'; see --help");
  } catch (const CLI::Error& error) {
    fail_usage(error.what(), "; see --help");
  }
}

}  // namespace facula
