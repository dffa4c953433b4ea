// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/cli/help.hpp>

#include <algorithm>
#include <sstream>

namespace facula {
namespace {

constexpr std::size_t kLineWidth = 96;

/// Words of `text`, wrapped, every line but the first behind `indent` blanks.
std::string wrapped(const std::string& text, std::size_t indent) {
  std::istringstream words(text);
  std::string result;
  std::size_t column = indent;
  for (std::string word; words >> word;) {
    if (column > indent && column + 1 + word.size() > kLineWidth) {
      result += "\n" + std::string(indent, ' ');
      column = indent;
    } else if (column > indent) {
      result += " ";
      ++column;
    }
    result += word;
    column += word.size();
  }
  return result;
}

/// A list of choices too long to stand beside its option is told in the help instead.
bool too_long(const ArgumentSpec& spec) {
  return !spec.positional() && spec.value_name.size() > 60;
}

std::string left_side(const ArgumentSpec& spec) {
  if (spec.positional()) return spec.repeatable ? spec.name + "..." : spec.name;
  if (spec.value_name.empty()) return spec.name;
  return spec.name + " " + (too_long(spec) ? "NAME" : spec.value_name);
}

std::string right_side(const ArgumentSpec& spec) {
  std::string text = spec.help;
  if (too_long(spec)) {
    text += ": ";
    for (const char letter : spec.value_name) {
      if (letter == '|') text += ", ";
      if (letter != '|') text += letter;
    }
  }
  if (!spec.default_text.empty() && !spec.required) text += " (default " + spec.default_text + ")";
  if (spec.required && !spec.positional()) text += " (required)";
  if (spec.repeatable && !spec.positional()) text += " (repeatable)";
  return text;
}

std::string usage(const Arguments& arguments, const std::string& called) {
  std::string line = called;
  for (const ArgumentSpec& spec : arguments.specs()) {
    if (!spec.positional() && !spec.required) continue;
    line += " " + (spec.required ? left_side(spec) : "[" + left_side(spec) + "]");
  }
  return line + " [options]";
}

void write_arguments(std::ostream& out, const Arguments& arguments, bool positional) {
  constexpr std::size_t kLeftWidth = 30;
  for (const ArgumentSpec& spec : arguments.specs()) {
    if (spec.positional() != positional) continue;
    const std::string left = "  " + left_side(spec);
    const bool fits = left.size() + 2 <= kLeftWidth;
    out << left
        << (fits ? std::string(kLeftWidth - left.size(), ' ') : "\n" + std::string(kLeftWidth, ' '))
        << wrapped(right_side(spec), kLeftWidth) << '\n';
  }
}

/// Name and summary of each command below the heading of its group.
void write_commands(std::ostream& out, const std::vector<Command>& commands) {
  std::size_t width = 0;
  for (const Command& command : commands) width = std::max(width, command.name.size());
  std::string group = "-";
  for (const Command& command : commands) {
    if (command.group != group) {
      group = command.group;
      out << '\n' << (group.empty() ? "Commands" : group) << ":\n";
    }
    out << "  " << command.name << std::string(width + 2 - command.name.size(), ' ')
        << command.summary << '\n';
  }
}

}  // namespace

std::string program_help(const std::vector<Command>& commands) {
  std::ostringstream out;
  out << "facula turns the frames of a line-laser scanner into scans, planes, meshes and maps.\n\n"
         "Usage: facula COMMAND [options]\n";
  write_commands(out, commands);
  out << "\n'facula COMMAND --help' explains one of them; 'facula --version' says which build this "
         "is.\nStart with: facula demo\n";
  return out.str();
}

std::string first_word_help(const std::string& word, const std::vector<Command>& commands) {
  std::vector<Command> of_word;
  for (const Command& command : commands) {
    if (command.name.starts_with(word + " ")) of_word.push_back(command);
  }
  std::ostringstream out;
  out << "Usage: facula " << word << " WHAT [options]\n";
  write_commands(out, of_word);
  out << "\n'facula " << word << " WHAT --help' explains one of them.\n";
  return out.str();
}

std::string command_help(const Command& command, const Arguments& arguments) {
  return program_help(command, arguments, "facula " + command.name);
}

std::string program_help(const Command& program,
                         const Arguments& arguments,
                         const std::string& called) {
  std::ostringstream out;
  out << wrapped(program.description, 0) << "\n\nUsage: " << wrapped(usage(arguments, called), 4)
      << "\n\n";
  const auto& specs = arguments.specs();
  if (std::any_of(specs.begin(), specs.end(), [](const auto& s) { return s.positional(); })) {
    out << "Arguments:\n";
    write_arguments(out, arguments, true);
    out << '\n';
  }
  out << "Options:\n";
  write_arguments(out, arguments, false);
  out << "\nExamples (data/... are files that come with facula, found from every folder):\n";
  for (const std::string& example : program.examples) out << "  " << example << '\n';
  return out.str();
}

}  // namespace facula
