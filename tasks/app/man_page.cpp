#include "pincer/tasks/app/man_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <sstream>

namespace pincer::tasks {
namespace {

// Text as roff shows it as it stands: hyphens stay what a shell takes, no line is taken for a request.
std::string roff(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    const bool begins = escaped.empty() || escaped.back() == '\n';
    if (begins && (c == '.' || c == '\'')) escaped += "\\&";
    if (c == '\\') {
      escaped += "\\e";
    } else if (c == '-') {
      escaped += "\\-";
    } else {
      escaped += c;
    }
  }
  return escaped;
}

std::string upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

std::string synopsis(const CommandNode& command) {
  std::string text = fmt::format(".B {}\n[OPTIONS]", roff(joined(command.path, " ")));
  if (!command.commands.empty()) text += " COMMAND";
  for (const CommandOption& positional : command.positionals) {
    const std::string name = positional.names.front() + (positional.many ? " ..." : "");
    text += positional.required ? " " + roff(name) : " [" + roff(name) + "]";
  }
  return text + "\n";
}

std::string entry(const CommandOption& option) {
  std::string head = fmt::format(".TP\n\\fB{}\\fR", roff(joined(option.names, ", ")));
  if (!option.type.empty()) head += fmt::format(" \\fI{}\\fR", roff(option.type));
  std::string text = option.description;
  if (!option.range.empty())
    text += fmt::format("; {}", option.choices().empty() ? option.range : "one of " + joined(option.choices(), ", "));
  if (!option.fallback.empty()) text += fmt::format("; by default {}", option.fallback);
  if (option.required) text += "; must be given";
  return head + "\n" + roff(text) + "\n";
}

// The text below a command's help: paragraphs, then what begins with "Examples:", line by line.
std::string details(const std::string& text) {
  std::string page;
  bool as_it_stands = false, blank = true;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line == "Example:" || line == "Examples:") {
      page += ".SH EXAMPLES\n.nf\n";
      as_it_stands = true;
    } else if (line.empty()) {
      blank = true;
    } else {
      if (blank && as_it_stands && !page.ends_with(".nf\n")) page += "\n";
      if (blank && !as_it_stands) page += ".PP\n";
      blank = false;
      page += roff(line) + "\n";
    }
  }
  return as_it_stands ? page + ".fi\n" : page;
}

}  // namespace

std::string manPageName(const CommandNode& command) { return joined(command.path, "-") + ".1"; }

std::string manPage(const CommandNode& command, const std::string& version) {
  const std::string name = joined(command.path, "-");
  std::string page = fmt::format(".TH {} 1 \"\" \"pincer {}\" \"pincer\"\n", roff(upper(name)), version);
  page +=
      fmt::format(".SH NAME\n{} \\- {}\n.SH SYNOPSIS\n{}", roff(name), roff(command.description), synopsis(command));
  if (!command.positionals.empty() || !command.options.empty()) page += ".SH OPTIONS\n";
  for (const CommandOption& positional : command.positionals) page += entry(positional);
  for (const CommandOption& option : command.options) page += entry(option);
  if (!command.commands.empty()) page += ".SH COMMANDS\n";
  for (const CommandNode& below : command.commands) {
    page += fmt::format(".TP\n\\fB{}\\fR(1)\n{}\n", roff(joined(below.path, "-")), roff(below.description));
  }
  if (!command.details.empty()) page += ".SH DESCRIPTION\n" + details(command.details);
  page += ".SH EXIT STATUS\n0 ok, 1 a check failed, 2 usage, 3 bad input, 4 device, 5 interrupted.\n";
  if (command.path.size() > 1) page += fmt::format(".SH SEE ALSO\n\\fB{}\\fR(1)\n", roff(command.path.front()));
  return page;
}

}  // namespace pincer::tasks
