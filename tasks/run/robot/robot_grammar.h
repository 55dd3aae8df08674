// robot_grammar: the elements and attributes of a robot's file format, and for each of them what the importer does
// with it; and a file's tree held against that list, so that nothing is skipped in silence.
//
// An element of the same tag may mean different things in different places: rows have names of their own, found by
// the parent's row and the tag.
#pragma once
#include <span>
#include <string_view>

#include "pincer/tasks/run/robot/import_notes.h"
#include "pincer/tasks/run/robot/xml_tree.h"

namespace pincer::tasks {

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
  std::string_view reason = {};  // why it, or its refused attributes, are refused or ignored; a sentence
};

struct RobotGrammar {
  std::string_view format;             // "MJCF"
  std::span<const GrammarRow> rows;    // the root's has no parents
  std::string_view defaults_row = {};  // within it what is refused has no effect before an element uses it
  bool has_extensions = false;         // names with a prefix, as in "drake:joint", are what other programs add: ignored
};

// Null where the grammar has no such element in such a place; `parent_row` is empty for the root.
const GrammarRow* findRow(std::span<const GrammarRow> rows, std::string_view parent_row, std::string_view tag);
// False where the row has no such attribute.
bool findAttribute(const GrammarRow& row, std::string_view attribute, Verdict& verdict);

// Holds a file's root element and all below it against the grammar; adds what is ignored to the notes. Throws
// InputError at an element or attribute that the format doesn't have there or that is refused, and at text.
void checkGrammar(const RobotGrammar& grammar, const XmlElement& root, ImportNotes& notes);

// Throws InputError if text stands between the element's own.
void refuseText(const XmlElement& element);

// The words of a list, one after the other: calls act(word).
template <class Act>
void forEachWord(std::string_view words, Act act) {
  while (!words.empty()) {
    const auto end = words.find(' ');
    if (const auto word = words.substr(0, end); !word.empty()) act(word);
    words = end == std::string_view::npos ? std::string_view() : words.substr(end + 1);
  }
}

}  // namespace pincer::tasks
