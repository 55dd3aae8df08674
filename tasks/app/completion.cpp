#include "pincer/tasks/app/completion.h"

#include <fmt/format.h>

#include <algorithm>

namespace pincer::tasks {
namespace {

bool takesScene(const CommandNode& command) {
  return std::any_of(command.positionals.begin(), command.positionals.end(), [](const CommandOption& positional) {
    const std::string& name = positional.names.front();
    return name == "scene" || name == "scenes" || name == "source" || name == "what";
  });
}

// All that may come next but files.
std::vector<std::string> wordsAfter(const CommandNode& command, std::span<const std::string> scenes) {
  std::vector<std::string> words;
  for (const CommandNode& below : command.commands) words.push_back(below.path.back());
  for (const CommandOption& option : command.options)
    words.insert(words.end(), option.names.begin(), option.names.end());
  for (const CommandOption& positional : command.positionals) {
    for (const std::string& choice : positional.choices()) words.push_back(choice);
  }
  if (takesScene(command)) words.insert(words.end(), scenes.begin(), scenes.end());
  return words;
}

// Of descriptions, in single quotes of fish.
std::string fishText(const std::string& text) {
  std::string safe = "'";
  for (const char c : text) {
    if (c == '\'' || c == '\\') safe += '\\';
    safe += c;
  }
  return safe + "'";
}

}  // namespace

std::string bashCompletion(const CommandNode& root, std::span<const std::string> scenes) {
  std::string descents, offers, values;
  for (const CommandNode* command : everyCommand(root)) {
    const std::string path = joined(command->path, " ");
    for (const CommandNode& below : command->commands) descents += fmt::format("|\"{}\"", joined(below.path, " "));
    offers += fmt::format("    \"{}\") words=\"{}\" ;;\n", path, joined(wordsAfter(*command, scenes), " "));
    for (const CommandOption& option : command->options) {
      const std::vector<std::string> choices = option.choices();
      if (choices.empty()) continue;
      for (const std::string& name : option.names)
        values += fmt::format("    \"{} {}\") words=\"{}\" ;;\n", path, name, joined(choices, " "));
    }
  }
  return fmt::format(R"(# Completion of pincer's command line; made by `pincer completion`.
_pincer() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} path=pincer words='' chosen i
  for ((i = 1; i < COMP_CWORD; ++i)); do
    case "$path ${{COMP_WORDS[i]}}" in
    {}) path="$path ${{COMP_WORDS[i]}}" ;;
    esac
  done
  case "$path ${{COMP_WORDS[COMP_CWORD - 1]}}" in
{}    esac
  chosen=$words
  if [[ -z $words ]]; then
    case $path in
{}    esac
  fi
  COMPREPLY=()
  local word
  for word in $words; do
    [[ $word == "$current"* && ( $word != -* || $current == -* ) ]] && COMPREPLY+=("$word")
  done
  if [[ $current != -* && $path != pincer && -z $chosen ]]; then
    while IFS= read -r word; do COMPREPLY+=("$word"); done < <(compgen -f -- "$current")
  fi
  return 0
}}
complete -o filenames -F _pincer pincer
)",
                     descents.substr(std::min<std::size_t>(descents.size(), 1)), values, offers);
}

std::string zshCompletion(const CommandNode& root, std::span<const std::string> scenes) {
  return "#compdef pincer\nautoload -U +X bashcompinit && bashcompinit\n" + bashCompletion(root, scenes);
}

std::string fishCompletion(const CommandNode& root, std::span<const std::string> scenes) {
  std::string text = "# Completion of pincer's command line; made by `pincer completion`.\n";
  for (const CommandNode* command : everyCommand(root)) {
    std::string when = "__fish_use_subcommand";
    for (std::size_t i = 1; i < command->path.size(); ++i) {
      when = (i == 1 ? "" : when + "; and ") + fmt::format("__fish_seen_subcommand_from {}", command->path[i]);
    }
    const std::string begin = fmt::format("complete -c pincer -n {}", fishText(when));
    for (const CommandNode& below : command->commands) {
      text += fmt::format("{} -f -a {} -d {}\n", begin, fishText(below.path.back()), fishText(below.description));
    }
    for (const CommandOption& option : command->options) {
      std::string names;
      for (const std::string& name : option.names) {
        names += name.starts_with("--") ? fmt::format(" -l {}", name.substr(2)) : fmt::format(" -s {}", name.substr(1));
      }
      const std::string value = option.type.empty() ? ""
                                : option.choices().empty()
                                    ? " -r"
                                    : fmt::format(" -x -a {}", fishText(joined(option.choices(), " ")));
      text += fmt::format("{}{}{} -d {}\n", begin, names, value, fishText(option.description));
    }
    if (takesScene(*command)) {
      text += fmt::format("{} -a {}\n", begin,
                          fishText(joined(std::vector<std::string>(scenes.begin(), scenes.end()), " ")));
    }
  }
  return text;
}

}  // namespace pincer::tasks
