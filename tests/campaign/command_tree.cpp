#include "pincer/tests/campaign/command_tree.h"

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "pincer/tests/campaign/inputs.h"

namespace pincer::campaign {
namespace {

std::string helpOf(const Ground& ground, std::vector<std::string> words) {
  words.push_back("--help");
  Launch launch;
  launch.program = ground.pincer;
  launch.arguments = words;
  launch.folder = ground.inputs();
  launch.log = ground.inputs() / "log";
  const Ended ended = run(launch);
  if (ended.exit_code != 0 || ended.signal != 0) throw std::runtime_error(shellText(launch) + " failed");
  return ended.out;
}

// Of "  -h,--help   Text" the name "--help", of "  --seed UINT=1   Text" also the type "UINT=1": a text
//                                                                  begins after two blanks at least.
Option optionIn(const std::string& line) {
  const std::string head = line.substr(2, line.find("  ", 2) - 2);
  Option option;
  std::istringstream words(head);
  words >> option.name;
  option.name = option.name.substr(option.name.rfind(',') + 1);
  option.name = option.name.substr(0, option.name.find('{'));
  for (std::string word; words >> word;) {
    if (word == "REQUIRED") option.required = true;
    if (option.type.empty() && word != "REQUIRED" && word != "Needs:") option.type = word;
  }
  return option;
}

struct Help {
  Command command;
  std::vector<std::string> subcommands;
};

Help parse(const std::string& text, const std::vector<std::string>& words) {
  Help help{{words, {}, {}}, {}};
  std::string section;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.empty()) section.clear();
    if (line == "Options:" || line == "Positionals:" || line == "Subcommands:") section = line;
    if (line.starts_with("Commands ") && line.ends_with(':')) section = "Subcommands:";  // of one kind
    if (section.empty() || line.size() < 4 || !line.starts_with("  ") || line[2] == ' ') continue;
    const Option option = optionIn(line);
    if (section == "Options:") help.command.options.push_back(option);
    if (section == "Positionals:") help.command.positionals.push_back(option);
    if (section == "Subcommands:") help.subcommands.push_back(option.name);
  }
  return help;
}

void addCommands(const Ground& ground, const std::vector<std::string>& words, std::vector<Command>& found) {
  const Help help = parse(helpOf(ground, words), words);
  if (help.subcommands.empty()) found.push_back(help.command);
  for (const std::string& name : help.subcommands) {
    std::vector<std::string> longer = words;
    longer.push_back(name);
    addCommands(ground, longer, found);
  }
}

// The first of "TEXT:{a,b}"; empty if the type lists none.
std::string firstChoice(const std::string& type) {
  const std::size_t at = type.find('{');
  return at == type.npos ? "" : type.substr(at + 1, type.find_first_of(",}", at) - at - 1);
}

std::string soundValue(const Ground& ground, const Option& wanted) {
  const std::string choice = firstChoice(wanted.type);
  if (!choice.empty()) return choice;
  if (wanted.name == "session") return pickupSession(ground);
  if (wanted.name == "scene") return ground.inputs() / "scenes/s4_pinch.json";
  if (wanted.name == "what") return "s4_pinch";
  if (wanted.name == "source") return "s4_pinch";
  if (wanted.name == "file") return ground.inputs() / "meshes/cube.obj";
  if (wanted.name == "out") return "out.obj";
  if (wanted.name == "--vary") return "sphere.material.mu_s=0.4,0.5";
  return "1";
}

// Makes runs short: of whatever a command has of these.
const std::vector<std::pair<std::string, std::string>> kShort = {
    {"--duration", "0.05"},        {"--ticks", "100"},      {"--seeds", "1"},
    {"--repetitions", "1"},        {"--participants", "1"}, {"--no-report", ""},
    {"--experiments", "1"},        {"--list", ""},          {"--study-experiments", "0"},
    {"--control-experiments", "1"}};

}  // namespace

std::vector<Command> commandsOf(const Ground& ground) {
  std::vector<Command> found;
  addCommands(ground, {}, found);
  return found;
}

std::vector<std::string> soundArguments(const Ground& ground, const Command& command) {
  std::vector<std::string> arguments = command.words;
  for (const Option& positional : command.positionals) {
    if (positional.required) arguments.push_back(soundValue(ground, positional));
  }
  for (const Option& option : command.options) {
    const auto brief =
        std::find_if(kShort.begin(), kShort.end(), [&](const auto& s) { return s.first == option.name; });
    if (!option.required && brief == kShort.end() && option.name != "--out") continue;
    arguments.push_back(option.name);
    if (option.type.empty()) continue;
    arguments.push_back(option.required ? soundValue(ground, option) : brief != kShort.end() ? brief->second : "out");
  }
  return arguments;
}

}  // namespace pincer::campaign
