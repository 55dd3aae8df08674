// Command lines: every command with every option, its value absurd, missing, given twice; words that no command knows.
#include <fmt/format.h>

#include <algorithm>

#include "pincer/tests/campaign/command_tree.h"
#include "pincer/tests/campaign/mutation.h"
#include "pincer/tests/campaign/rows.h"

namespace pincer::campaign {
namespace {

// Texts that no option takes which wants a number.
const std::set<std::string>& noNumbers() {
  static const std::set<std::string> kNone = {" ",    "abc",  "%s%n%n", "NaN",   "nan",    "inf",
                                              "-inf", "null", "{}",     "=1+1",  "a\nb",   ".",
                                              "/",    "1e",   "--1",    "1e309", "-1e309", "1e999"};
  return kNone;
}

const std::vector<std::string>& absurdValues() {
  static const std::vector<std::string> kValues = [] {
    std::vector<std::string> values = {"",
                                       " ",
                                       "abc",
                                       "--",
                                       "-",
                                       "-x",
                                       "%s%n%n",
                                       "\x1b[31mred\x07",
                                       "\xff\xfe",
                                       "1,2",
                                       "1 2",
                                       "1e12",
                                       "1e999",
                                       "NaN",
                                       "null",
                                       "true",
                                       "{}",
                                       "[1]",
                                       "=1+1",
                                       "'\"`$(x)",
                                       "a\nb",
                                       "no/such/place",
                                       ".",
                                       "/dev/null",
                                       "/",
                                       "1:2:3",
                                       "1:0:0",
                                       "x=y=z",
                                       "a=1:2:3:4",
                                       "a=1:2:1e9",
                                       "../..",
                                       "/dev/full",
                                       "\xe2\x80\xae"};
    values.insert(values.end(), extremeNumbers().begin(), extremeNumbers().end());
    values.push_back(std::string(100'000, 'x'));
    values.push_back(std::string(5'000, '9'));
    return values;
  }();
  return kValues;
}

// Motors might be attached to this machine: whoever may reach one is left out (main.cpp looks which devices are there).
bool mayMoveMotors(const Command& command) { return command.words[0] == "devices"; }

const std::vector<Command>& commands(const Ground& ground) {
  static const std::vector<Command> kCommands = [&] {
    std::vector<Command> all = commandsOf(ground);
    if (ground.has_devices) std::erase_if(all, mayMoveMotors);
    return all;
  }();
  return kCommands;
}

struct Harm {
  std::size_t command, option, value;
};

// Beyond the values: left out, given twice, as --option=, unknown option, unknown word.
constexpr std::size_t kWays = 5;

std::vector<Harm> harmsOf(const Ground& ground) {
  std::vector<Harm> harms;
  for (std::size_t c = 0; c < commands(ground).size(); ++c) {
    const Command& command = commands(ground)[c];
    const std::size_t places = command.options.size() + command.positionals.size();
    for (std::size_t o = 0; o < places; ++o) {
      for (std::size_t v = 0; v < absurdValues().size() + kWays; ++v) harms.push_back({c, o, v});
    }
  }
  return harms;
}

const std::vector<Harm>& harms(const Ground& ground) {
  static const std::vector<Harm> kHarms = harmsOf(ground);
  return kHarms;
}

void removeOption(std::vector<std::string>& arguments, const Option& option) {
  const auto at = std::find(arguments.begin(), arguments.end(), option.name);
  if (at == arguments.end()) return;
  arguments.erase(at, option.type.empty() || at + 1 == arguments.end() ? at + 1 : at + 2);
}

void harmPositional(std::vector<std::string>& arguments, const Command& command, std::size_t place, std::size_t value) {
  const std::size_t at = command.words.size() + place;
  if (value < absurdValues().size()) {
    if (at >= arguments.size()) arguments.resize(at + 1, "x");
    arguments[at] = absurdValues()[value];
  } else if (value % 2 == 0 && at < arguments.size()) {
    arguments.erase(arguments.begin() + static_cast<std::ptrdiff_t>(at));
  } else {
    arguments.push_back("one-more-word");
  }
}

void harmOption(std::vector<std::string>& arguments, const Option& option, std::size_t value,
                const std::string& extreme) {
  const auto add = [&](std::initializer_list<std::string> more) { arguments.insert(arguments.end(), more); };
  if (value < absurdValues().size()) {
    removeOption(arguments, option);
    return option.type.empty() ? add({option.name + "=" + absurdValues()[value]})
                               : add({option.name, absurdValues()[value]});
  }
  switch (value - absurdValues().size()) {
    case 0:
      return add({option.name});
    case 1:
      return option.type.empty() ? add({option.name, option.name}) : add({option.name, extreme, option.name, extreme});
    case 2:
      return add({option.name + "="});
    case 3:
      return add({option.name + "x", extreme});
    default:
      return add({"one-more-word"});
  }
}

bool isUsage(const Option& option, const std::string& value) {
  const bool wants_number =
      option.type.starts_with("INT") || option.type.starts_with("UINT") || option.type.starts_with("FLOAT");
  return wants_number && noNumbers().contains(value);
}

}  // namespace

int allCommandLines(const Ground& ground) { return static_cast<int>(harms(ground).size()); }

void harmCommandLine(Case& c) {
  const Harm& harm = harms(c.ground)[scattered(c.ground, c.number, harms(c.ground).size())];
  const Command& command = commands(c.ground)[harm.command];
  std::vector<std::string> arguments = soundArguments(c.ground, command);
  const std::size_t options = command.options.size();
  if (harm.option < options) {
    harmOption(arguments, command.options[harm.option], harm.value, c.anyOf(extremeNumbers()));
  } else {
    harmPositional(arguments, command, harm.option - options, harm.value);
  }
  Launch launch = c.pincer(arguments);
  launch.limit = 0.3;  // what was taken runs, and is asked to stop
  Expect expect;
  if (harm.option < options && harm.value < absurdValues().size() &&
      isUsage(command.options[harm.option], absurdValues()[harm.value]))
    expect.codes = {2};
  c.run(launch, expect);
}

}  // namespace pincer::campaign
