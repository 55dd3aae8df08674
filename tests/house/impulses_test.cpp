// The ways in which an impulse comes about: every function of the engine's headers that
// writes one is listed here, with what it does.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <string>

namespace {

namespace fs = std::filesystem;

const std::map<std::string, std::string> kWritesImpulses = {
    {"solveContacts", "the front door"},
    {"solveSmallProblem", "way 1: the small form, up to three contacts"},
    {"solveStuckContacts", "way 2, where all stick: one step"},
    {"solveGripProblem", "the same step, of a free body between flat pads"},
    {"solveFewContacts", "way 2: up to sixty"},
    {"iterateNewton", "way 2: steps of Newton's method"},
    {"iterateGiving", "way 2: rounds of it, of contacts that contradict each other"},
    {"iterateSoftly", "way 2: of contacts that squeeze, as if they were soft"},
    {"followCentralPath", "way 2: an interior point, before Newton's method"},
    {"solvePointProblem", "way 2, last resort of a point between walls"},
    {"searchImpulses", "way 3: many; descents, rounds and sweeps"},
    {"stopBySweeps", "the front door, where there is no answer: the same sweeps"},
    {"Sweeps", "way 3, between balls and where factors don't fit: contact by contact"},
    {"solveOneContact", "one contact, exactly"},
    {"limitFriction", "the law of one contact"},
    {"projectOntoCones", "the law of all of them"},
};

// Names of functions with a parameter `r`, or an iterate `current`, that they may write.
std::set<std::string> writersIn(const fs::path& header) {
  std::ifstream in(header);
  const std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  static const std::regex function(R"((\w+)\(([^()]*)\))"),
      written(R"((^|,)\s*(double\* r|VectorMap r|Iterate& current)\s*(,|$))");
  std::set<std::string> names;
  for (std::sregex_iterator it(text.begin(), text.end(), function), end; it != end; ++it) {
    const std::string parameters = (*it)[2];
    if (std::regex_search(parameters, written)) names.insert((*it)[1]);
  }
  return names;
}

TEST(House, WaysOfAnImpulseAreListed) {
  std::set<std::string> found;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(PINCER_SOURCE_DIR) / "engine")) {
    if (entry.path().extension() != ".h") continue;
    for (const std::string& name : writersIn(entry.path())) {
      EXPECT_TRUE(kWritesImpulses.contains(name))
          << fmt::format("{}: {} writes an impulse: a way more?", entry.path().string(), name);
      found.insert(name);
    }
  }
  for (const auto& [name, what] : kWritesImpulses)
    EXPECT_TRUE(found.contains(name)) << name << " is listed (" << what << ") and gone";
}

}  // namespace
