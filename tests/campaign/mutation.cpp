#include "pincer/tests/campaign/mutation.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace pincer::campaign {
namespace {

using Tokens = std::vector<std::string>;
constexpr std::size_t kHugeKey = 5'000'000;  // [bytes] of a name that somebody may compare with all others
constexpr std::size_t kDeep = 200'000;       // brackets: more than a stack of 8 MB holds, if each costs a call

std::size_t below(RandomNumbers& random, std::size_t n) {
  return n == 0 ? 0 : static_cast<std::size_t>(random.bits() % n);
}

const std::string& anyOf(RandomNumbers& random, const Tokens& choices) {
  return choices[below(random, choices.size())];
}

bool isNumber(const std::string& token) {
  return !token.empty() && (std::isdigit(static_cast<unsigned char>(token.back())) != 0) && token[0] != '"';
}
bool isBlank(const std::string& token) { return token.find_first_not_of(" \t\r\n") == token.npos; }
bool isString(const std::string& token) { return token.size() > 1 && token[0] == '"'; }

bool belongsToWord(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.' || c == '+' || c == '-';
}
bool belongsToBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

std::size_t endOfString(const std::string& text, std::size_t at) {
  for (++at; at < text.size() && text[at] != '"'; ++at) at += text[at] == '\\';
  return std::min(at + 1, text.size());
}

std::size_t endOfToken(const std::string& text, std::size_t at) {
  if (text[at] == '"') return endOfString(text, at);
  const auto belongs = belongsToBlank(text[at]) ? belongsToBlank : belongsToWord;
  std::size_t end = at + 1;
  while (belongs(text[at]) && end < text.size() && belongs(text[end])) ++end;
  return end;
}

std::string joined(const Tokens& tokens) {
  std::string text;
  for (const std::string& token : tokens) text += token;
  return text;
}

// A place of a token that `wanted` likes; tokens.size() if there is none.
template <class Wanted>
std::size_t placeOf(RandomNumbers& random, const Tokens& tokens, Wanted wanted) {
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < tokens.size(); ++i) {
    if (wanted(tokens[i])) places.push_back(i);
  }
  return places.empty() ? tokens.size() : places[below(random, places.size())];
}

void replaceNumber(RandomNumbers& random, Tokens& tokens) {
  const std::size_t at = placeOf(random, tokens, isNumber);
  if (at < tokens.size()) tokens[at] = anyOf(random, extremeNumbers());
}

// Another number of the same text: what is read is sound but for its sense.
void copyNumber(RandomNumbers& random, Tokens& tokens) {
  const std::size_t from = placeOf(random, tokens, isNumber), to = placeOf(random, tokens, isNumber);
  if (from < tokens.size()) tokens[to] = tokens[from];
}

void exchangeTokens(RandomNumbers& random, Tokens& tokens) {
  const auto solid = [](const std::string& token) { return !isBlank(token); };
  const std::size_t a = placeOf(random, tokens, solid), b = placeOf(random, tokens, solid);
  if (a < tokens.size()) std::swap(tokens[a], tokens[b]);
}

std::string lineHarmed(RandomNumbers& random, const std::string& text) {
  const std::size_t at = below(random, text.size());
  const std::size_t begin = text.rfind('\n', at) + 1;  // npos + 1: 0
  const std::size_t end = std::min(text.find('\n', at), text.size() - 1) + 1;
  if (begin >= end) return text;
  const std::string line = text.substr(begin, end - begin);
  return text.substr(0, begin) + (random.below(2) == 0 ? line + line : "") + text.substr(end);
}

// Another type, another name, another length: what stands in place of a string or a number.
std::string strangeValue(RandomNumbers& random) {
  static const Tokens kStrange = {"null",
                                  "true",
                                  "[]",
                                  "{}",
                                  "\"\"",
                                  "\"text\"",
                                  "[[[[1]]]]",
                                  "{\"a\": {\"b\": null}}",
                                  "[1, 2]",
                                  "\"\\u0000\"",
                                  "\"\\ud800\"",
                                  "\"a\\u001b[31mred\"",
                                  "\"../../../etc/passwd\"",
                                  "\"/dev/null\"",
                                  "nan",
                                  "Infinity",
                                  "'x'",
                                  "\"$(touch pwned)\"",
                                  "\"=1+1\"",
                                  "\"<script>alert(1)</script>\"",
                                  "/* unclosed",
                                  "// to the end"};
  return anyOf(random, kStrange);
}

std::string hugeName(RandomNumbers& random) {
  return '"' + std::string(random.below(4) == 0 ? kHugeKey : 10'000, 'k') + '"';
}

std::string nested(RandomNumbers& random) {
  const std::size_t depth = random.below(2) == 0 ? kDeep : 300;
  std::string deep;
  for (std::size_t i = 0; i < depth; ++i) deep += random.below(2) == 0 ? "[" : "{\"a\":";
  return deep;
}

void harmJsonToken(RandomNumbers& random, Tokens& tokens) {
  const auto value = [](const std::string& token) {
    return isNumber(token) || isString(token) || token == "true" || token == "false";
  };
  const std::size_t at = placeOf(random, tokens, random.below(3) == 0 ? isString : value);
  if (at == tokens.size()) return;
  switch (random.below(8)) {
    case 0:
      tokens[at] = hugeName(random);
      break;
    case 1:
      tokens[at] = nested(random);
      break;
    case 2:
      tokens[at] += tokens[at];
      break;
    case 3:
      tokens.erase(tokens.begin() + static_cast<std::ptrdiff_t>(at));
      break;
    case 4:
      if (isString(tokens[at]))
        tokens[at].insert(1 + below(random, tokens[at].size() - 1), random.below(2) == 0 ? "x" : "\xff\xfe");
      break;
    case 5:
      if (isString(tokens[at])) tokens[at].insert(1, "\x1b[31m\x07");
      break;
    default:
      tokens[at] = strangeValue(random);
  }
}

}  // namespace

const Tokens& extremeNumbers() {
  static const Tokens kExtremes = {"0",
                                   "-0",
                                   "-1",
                                   "1",
                                   "1e300",
                                   "-1e300",
                                   "1e308",
                                   "1e309",
                                   "-1e309",
                                   "1e-300",
                                   "4.9e-324",
                                   "1e-12",
                                   "1e6",
                                   "1e12",
                                   "1e18",
                                   "0.1",
                                   "255",
                                   "256",
                                   "65536",
                                   "2147483647",
                                   "2147483648",
                                   "-2147483649",
                                   "4294967296",
                                   "9007199254740993",
                                   "9223372036854775807",
                                   "9223372036854775808",
                                   "-9223372036854775808",
                                   "18446744073709551616",
                                   "99999999999999999999999999",
                                   "nan",
                                   "inf",
                                   "-inf",
                                   "0x10",
                                   "1.",
                                   ".5",
                                   "1e",
                                   "--1",
                                   "1,5",
                                   "1e+999999999"};
  return kExtremes;
}

Tokens tokensOf(const std::string& text) {
  Tokens tokens;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = endOfToken(text, at);
    tokens.push_back(text.substr(at, end - at));
    at = end;
  }
  return tokens;
}

std::string mutatedBytes(RandomNumbers& random, std::string bytes) {
  if (bytes.empty()) return "\x01";
  const std::size_t at = below(random, bytes.size());
  const std::size_t length = 1 + below(random, std::min<std::size_t>(bytes.size() - at, 1 + bytes.size() / 8));
  switch (random.below(6)) {
    case 0:
      return bytes.substr(0, at);
    case 1:
      return bytes.insert(below(random, bytes.size()), bytes.substr(at, length));
    case 2:
      return bytes.erase(at, length);
    case 3:
      return bytes.insert(at, std::string(1 + below(random, 16), random.below(2) == 0 ? '\0' : '\xff'));
    default:
      for (int n = 1 + random.below(8); n > 0; --n)
        bytes[below(random, bytes.size())] ^= static_cast<char>(1 << random.below(8));
      return bytes;
  }
}

std::string mutatedText(RandomNumbers& random, const std::string& text) {
  if (text.empty() || random.below(4) == 0) return mutatedBytes(random, text);
  if (random.below(4) == 0) return lineHarmed(random, text);
  Tokens tokens = tokensOf(text);
  constexpr std::array kHarms = {copyNumber, copyNumber, replaceNumber, exchangeTokens};
  const auto harm = kHarms[static_cast<std::size_t>(random.below(4))];
  for (int n = 1 + random.below(3); n > 0; --n) harm(random, tokens);
  return joined(tokens);
}

std::string mutatedJson(RandomNumbers& random, const std::string& text) {
  switch (random.below(12)) {
    case 0:
      return mutatedBytes(random, text);
    case 1:
      return lineHarmed(random, text);
    case 2:
      return "\xef\xbb\xbf" + text;
    case 3:
      return text + std::string(1, '\0') + "garbage";
    default:
      break;
  }
  Tokens tokens = tokensOf(text);
  for (int n = 1 + random.below(2); n > 0; --n) {
    const int kind = random.below(4);
    if (kind == 0) exchangeTokens(random, tokens);
    if (kind == 1) replaceNumber(random, tokens);
    if (kind > 1) harmJsonToken(random, tokens);
  }
  return joined(tokens);
}

}  // namespace pincer::campaign
