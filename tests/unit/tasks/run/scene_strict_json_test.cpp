// Strict JSON: each mistake is named with its line, and nothing else gets through.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "pincer/tasks/run/files/spelling.h"
#include "pincer/tasks/run/files/strict_json.h"

namespace pincer::tasks {
namespace {

constexpr std::array<std::string_view, 3> kKeys = {"mass", "radius", "mu_s"};

std::string messageOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::string parseMessage(const std::string& json) {
  return messageOf([&] { parseJson(json, "f.json"); });
}

TEST(StrictJson, KnowsTheLineAndPathOfEveryValue) {
  const JsonValue root = parseJson(
      "// a comment\n{\n  \"bodies\": [\n    {\"mass\": 1,\n     \"radius\":\n       2.5\n    },\n    7\n  ]\n}\n",
      "f.json");
  const JsonValue& bodies = root.at("bodies");
  EXPECT_EQ(bodies.line(), 3);
  EXPECT_EQ(bodies.array()[0].line(), 4);
  EXPECT_EQ(bodies.array()[0].at("mass").line(), 4);
  const JsonValue& radius = bodies.array()[0].at("radius");
  EXPECT_EQ(radius.line(), 6);
  EXPECT_EQ(radius.path(), "bodies[0].radius");
  EXPECT_EQ(radius.number(), 2.5);
  // a number is followed by a line break: its end is seen only on the next line
  EXPECT_EQ(bodies.array()[1].line(), 8);
  EXPECT_EQ(bodies.array()[1].path(), "bodies[1]");
}

// A list with one number per line: the k-th is on line k + 2, however the lines are padded.
RC_GTEST_PROP(StrictJson, CountsLines, (std::vector<std::int16_t> numbers)) {
  std::string json = "[";
  for (std::size_t i = 0; i < numbers.size(); ++i)
    json += (i ? ",\n" : "\n") + std::string(*rc::gen::inRange(0, 4), ' ') + std::to_string(numbers[i]);
  const JsonValue root = parseJson(json + "\n]", "f");
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    RC_ASSERT(root.array()[i].line() == static_cast<int>(i) + 2);
    RC_ASSERT(root.array()[i].number() == numbers[i]);
  }
}

TEST(StrictJson, NamesAValueOutOfRangeWithItsRangeAndRemedy) {
  const JsonValue root = parseJson("{\n \"mu_s\": -0.3}", "scenes/pickup.json");
  EXPECT_EQ(messageOf([&] { root.at("mu_s").number({.min = 0, .remedy = "It can't be negative."}); }),
            "scenes/pickup.json:2: mu_s = -0.3 is out of range [0, inf). It can't be negative.");
  EXPECT_EQ(messageOf([&] { root.at("mu_s").number({.min = -0.3, .max = 1, .min_open = true}); }),
            "scenes/pickup.json:2: mu_s = -0.3 is out of range (-0.3, 1].");
  EXPECT_EQ(root.at("mu_s").number({.min = -0.3, .max = -0.3}), -0.3);
}

TEST(StrictJson, NamesAnUnknownKeyAndWhatWasProbablyMeant) {
  const JsonValue root = parseJson("{\"mass\": 1,\n\"radios\": 2}", "f.json");
  EXPECT_EQ(messageOf([&] { root.allowOnly(kKeys); }), "f.json:2: radios isn't a known key. Did you mean \"radius\"?");
  const JsonValue other = parseJson("{\"colour\": 1}", "f.json");
  EXPECT_EQ(messageOf([&] { other.allowOnly(kKeys); }),
            "f.json:1: colour isn't a known key. Known here: mass, radius, mu_s.");
  EXPECT_EQ(messageOf([&] { parseJson("{\"mass\": 1}", "f").allowOnly(kKeys); }), "");
}

TEST(StrictJson, NamesDuplicateKeysWrongTypesAndMissingKeys) {
  EXPECT_EQ(parseMessage("{\"a\": 1,\n\"b\": 2,\n\"a\": 3}"),
            "f.json:3: the key \"a\" is there twice. Remove one of them.");
  const JsonValue root = parseJson("{\"a\": \"x\", \"b\": [1, 2], \"c\": 1.5}", "f.json");
  EXPECT_EQ(messageOf([&] { root.at("a").number(); }),
            "f.json:1: a = \"x\" has the wrong type: a number is needed here.");
  EXPECT_EQ(messageOf([&] { root.at("c").boolean(); }),
            "f.json:1: c = 1.5 has the wrong type: true or false is needed here.");
  EXPECT_EQ(messageOf([&] { root.at("b").vector(); }),
            "f.json:1: b has 2 elements, but a vector has three: [x, y, z].");
  EXPECT_EQ(messageOf([&] { root.at("c").integer(0, 9, "Whole."); }), "f.json:1: c = 1.5 isn't a whole number. Whole.");
  EXPECT_EQ(messageOf([&] { root.at("d", "It is needed."); }),
            "f.json:1: the whole file lacks the key \"d\". It is needed.");
}

TEST(StrictJson, TakesNoNumberThatIsNotFinite) {
  for (const char* text : {"[NaN]", "[Infinity]", "[-inf]", "[1e999]", "[-1e999]"})
    EXPECT_NE(parseMessage(text), "") << text;
}

TEST(StrictJson, NamesTheLineWhereTheSyntaxBreaks) {
  EXPECT_EQ(parseMessage("{\"a\": 1,\n \"b\" 2}").substr(0, 9), "f.json:2:");
  for (const char* text : {"", "{", "[1, 2", "{\"a\": }", "{} {}", "[1,]", "\"open", "{'a': 1}", "/* open"}) {
    EXPECT_EQ(parseMessage(text).substr(0, 7), "f.json:") << text;
  }
}

TEST(StrictJson, RefusesEndlessNesting) {
  EXPECT_NE(parseMessage(std::string(100000, '[')).find("nested"), std::string::npos);
}

// Every prefix of a good file, and the file with any one byte replaced, either parses or throws InputError.
RC_GTEST_PROP(StrictJson, SurvivesDamage, ()) {
  std::string json = "{\"version\": 1, // x\n \"list\": [1.5e-3, true, null, \"t\\u00e4xt\"], \"o\": {\"a\": {}}}";
  const auto at = *rc::gen::inRange<std::size_t>(0, json.size());
  if (*rc::gen::arbitrary<bool>()) {
    json[at] = *rc::gen::arbitrary<char>();
  } else {
    json.resize(at);
  }
  try {
    parseJson(json, "f");
  } catch (const InputError&) {
  }
}

TEST(EditDistance, CountsLetters) {
  EXPECT_EQ(editDistance("", "abc"), 3);
  EXPECT_EQ(editDistance("kitten", "sitting"), 3);  // the textbook example
  EXPECT_EQ(editDistance("mass", "mass"), 0);
  EXPECT_EQ(editDistance("smi", "sim"), 1);
  EXPECT_EQ(editDistance("ca", "abc"), 2);  // swapped, and b between: not by swaps of what stays neighbours
}

RC_GTEST_PROP(EditDistance, IsAMetric, (const std::string& a, const std::string& b, const std::string& c)) {
  RC_ASSERT(editDistance(a, b) == editDistance(b, a));
  RC_ASSERT((editDistance(a, b) == 0) == (a == b));
  RC_ASSERT(editDistance(a, c) <= editDistance(a, b) + editDistance(b, c));
}

}  // namespace
}  // namespace pincer::tasks
