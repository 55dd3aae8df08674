// JSON texts by the walk and by a library of another make: the same texts are sound, and the same values are in them.
#include "pincer/devices/haply/json_walk.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "pincer/devices/emulate/changed_json.h"
#include "pincer/tests/unit/devices/haply/haply_texts.h"

namespace pincer::devices::haply {
namespace {

using nlohmann::ordered_json;

struct Told {
  std::string path;
  ordered_json value;
  bool operator==(const Told&) const = default;
};

class Keeper final : public JsonSink {
 public:
  bool value(std::string_view path, const JsonScalar& value) override {
    told.push_back({std::string(path), std::visit([](const auto& v) { return valueOf(v); }, value)});
    return true;
  }
  bool begin(std::string_view, bool) override { return ++opened > 0; }
  bool end(std::string_view, bool) override { return --opened >= 0; }
  std::vector<Told> told;
  int opened = 0;

 private:
  static ordered_json valueOf(std::monostate) { return nullptr; }
  static ordered_json valueOf(std::string_view text) { return std::string(text); }
  template <typename T>
  static ordered_json valueOf(T value) {
    return value;
  }
};

std::string joined(const std::string& path, std::string key) {
  std::replace(key.begin(), key.end(), '.', '/');
  if (key.empty()) key = "/";
  return path.empty() ? key : path + "." + key;
}

// Likewise, from the other library's tree.
void flatten(const ordered_json& tree, const std::string& path, std::vector<Told>& told) {
  if (tree.is_object()) {
    for (const auto& [key, value] : tree.items()) flatten(value, joined(path, key), told);
  } else if (tree.is_array()) {
    for (const auto& value : tree) flatten(value, path, told);
  } else {
    told.push_back({path, tree.is_number() ? ordered_json(tree.get<double>()) : tree});
  }
}

bool isSound(const std::string& text) {
  Keeper keeper;
  return walkJson(text, keeper);
}

// Refused by the walk alone: nested too deep, or an integer of more than 64 bits.
bool isBeyondTheWalk(const std::string& text) {
  int depth = 0, deepest = 0;
  std::size_t digits = 0, longest = 0;
  for (const char c : text) {
    depth += (c == '{' || c == '[' ? 1 : 0) - (c == '}' || c == ']' ? 1 : 0);
    digits = c >= '0' && c <= '9' ? digits + 1 : 0;
    deepest = std::max(deepest, depth);
    longest = std::max(longest, digits);
  }
  return deepest > 8 || longest > 18;
}

TEST(JsonWalk, TellsTheValuesThatAnotherLibraryFinds) {
  for (
      const std::string& text :
      {tests::kHaplyInventory, tests::kHaplySafetyEvent, tests::kHaplyForces,
       std::string(R"(  [1,[-0.0,{"b":true,"":null,"x.y":[[],{},"z"]}]] )"),
       std::string(
           R"({"a":"\"\\\/\b\f\n\r\t\u00e9\ud83d\ude00","b":[5e-324,1.7976931348623157e308,18446744073709551615,-9223372036854775808]})"),
       std::string("7"), std::string("\"x\""), std::string("[[[[[[[[1]]]]]]]]")}) {
    Keeper keeper;
    EXPECT_TRUE(walkJson(text, keeper)) << text;
    EXPECT_EQ(keeper.opened, 0);
    std::vector<Told> wanted;
    flatten(ordered_json::parse(text), "", wanted);
    ASSERT_EQ(keeper.told.size(), wanted.size()) << text;
    for (std::size_t i = 0; i < wanted.size(); ++i)
      EXPECT_EQ(keeper.told[i], wanted[i]) << wanted[i].path << " of " << text;
  }
}

TEST(JsonWalk, ReadsNumbersToTheLastBit) {
  std::mt19937_64 random(41);
  std::uniform_real_distribution<double> exponent(-310, 308), digits(-1, 1);
  for (int i = 0; i < 10'000; ++i) {
    const std::string text = ordered_json(digits(random) * std::pow(10.0, exponent(random))).dump();
    Keeper keeper;
    ASSERT_TRUE(walkJson(text, keeper)) << text;
    EXPECT_EQ(keeper.told[0].value.get<double>(), ordered_json::parse(text).get<double>()) << text;
  }
}

TEST(JsonWalk, TakesMutatedTextsThatAnotherLibraryTakesAndNoOthers) {
  std::mt19937_64 random(40);
  const std::array<std::string, 3> seeds{tests::kHaplySafetyEvent,
                                         R"({"a":[1,-2.5e3,{"b":true,"":null,"x.y":[[],{}]}],"c":"é\u00e9\n"})",
                                         "[[[[[[[[1]]]]]]]]"};
  int sound = 0, refused = 0;
  for (std::size_t i = 0; i < 30'000; ++i) {
    const std::string text = emulate::changedJson(seeds[i % seeds.size()], 3, random);
    const bool taken = isSound(text), wanted = nlohmann::json::accept(text);
    EXPECT_TRUE(taken == wanted || (wanted && isBeyondTheWalk(text))) << text;
    (taken ? sound : refused) += 1;
  }
  EXPECT_GT(sound, 2000);
  EXPECT_GT(refused, 5000);
}

TEST(JsonWalk, RefusesWhatItCanNotHold) {
  EXPECT_FALSE(isSound("[[[[[[[[[]]]]]]]]]")) << "nine deep";
  EXPECT_FALSE(isSound(std::string(100'000, '['))) << "no stack is that deep";
  EXPECT_FALSE(isSound("{\"" + std::string(129, 'k') + "\":1}"));
  EXPECT_TRUE(isSound("{\"" + std::string(128, 'k') + "\":1}"));
  EXPECT_FALSE(isSound("18446744073709551616")) << "more than 64 bits";
  for (const char* text : {"", " ", "nul", "1e400", "NaN", "01", "{} {}", "\"\xff\"", "{\"a\":}", "[1,]"})
    EXPECT_FALSE(isSound(text)) << text;
}

// A sink that has had enough ends the walk, wherever it is.
TEST(JsonWalk, EndsWhereTheSinkSays) {
  class Enough final : public JsonSink {
   public:
    explicit Enough(int most) : left(most) {}
    bool value(std::string_view, const JsonScalar&) override { return left-- > 0; }
    bool begin(std::string_view, bool) override { return left-- > 0; }
    bool end(std::string_view, bool) override { return left-- > 0; }
    int left;
  };
  constexpr int kCalls = 9;  // of the text below
  for (int most = 0; most <= kCalls; ++most) {
    Enough sink(most);
    EXPECT_EQ(walkJson(R"({"a":[1,{"b":2}],"c":null})", sink), most == kCalls) << most;
  }
}

}  // namespace
}  // namespace pincer::devices::haply
