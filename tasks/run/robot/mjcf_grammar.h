// mjcf_grammar: the elements and attributes of MJCF, and for each of them what the importer does with it.
//
// The names are those of the grammar that MuJoCo publishes (mjcf.schema, August 2026). An element of
// the same tag means different things in different places: rows have names of their own
// ("equality_joint"), found by the parent's row and the tag.
#pragma once
#include <span>
#include <string_view>

namespace pincer::tasks::mjcf {

enum class Verdict {
  kRead,
  kLooks,    // pictures and bookkeeping, skipped without a word
  kIgnored,  // skipped with a warning that counts it
  kRefused,  // an error by name and line
};

// Words are separated by blanks.
struct GrammarRow {
  std::string_view name, tag;
  std::string_view parents;  // rows in which it stands
  Verdict verdict = Verdict::kRead;
  std::string_view read = {}, looks = {}, ignored = {}, refused = {};  // attributes, of a row that is read
  std::string_view reason = {};  // why it, or its refused attributes, are refused; a sentence
};

std::span<const GrammarRow> grammar();

// Null where the grammar has no such element in such a place.
const GrammarRow* findRow(std::string_view parent_row, std::string_view tag);
// Null-like: false where the row has no such attribute.
bool findAttribute(const GrammarRow& row, std::string_view attribute, Verdict& verdict);

// The words of a list, one after the other: calls act(word).
template <class Act>
void forEachWord(std::string_view words, Act act) {
  while (!words.empty()) {
    const auto end = words.find(' ');
    if (const auto word = words.substr(0, end); !word.empty()) act(word);
    words = end == std::string_view::npos ? std::string_view() : words.substr(end + 1);
  }
}

}  // namespace pincer::tasks::mjcf
