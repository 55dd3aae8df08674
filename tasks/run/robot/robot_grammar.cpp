#include "pincer/tasks/run/robot/robot_grammar.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "pincer/contact/io/printable.h"
#include "pincer/tasks/run/files/spelling.h"

namespace pincer::tasks {
namespace {

constexpr std::size_t kMostOfText = 40;  // letters of a text that a message quotes

bool has(std::string_view words, std::string_view word) {
  bool found = false;
  forEachWord(words, [&](std::string_view w) { found = found || w == word; });
  return found;
}

std::string spelling(const GrammarRow& row, const std::string& name) {
  std::vector<std::string_view> words;
  for (const std::string_view list : {row.read, row.looks, row.ignored, row.refused})
    forEachWord(list, [&](auto w) { words.push_back(w); });
  return suggestion(name, words);
}

class Checker {
 public:
  Checker(const RobotGrammar& grammar, ImportNotes& notes) : grammar_(grammar), notes_(notes) {}

  void check(const XmlElement& element, const GrammarRow& row) {
    refuseText(element);
    for (const XmlAttribute& attribute : element.attributes) checkAttribute(element, attribute.name, row);
    for (const XmlElement& child : element.children) checkChild(child, row);
  }

 private:
  bool isExtension(const std::string& name) const {
    return grammar_.has_extensions && name.find(':') != std::string::npos;
  }

  void checkAttribute(const XmlElement& element, const std::string& name, const GrammarRow& row) {
    if (name.rfind("xmlns", 0) == 0) return;  // XML's own
    if (isExtension(name)) return notes_.add(fmt::format("{} {}", element.tag, name), "", element.place());
    Verdict verdict;
    if (!findAttribute(row, name, verdict)) {
      element.reject(fmt::format("has the attribute \"{}\", which {} doesn't know there.{}", name, grammar_.format,
                                 spelling(row, name)));
    }
    if (verdict == Verdict::kIgnored)
      notes_.add(fmt::format("{} {}", element.tag, name), std::string(row.refused.empty() ? row.reason : ""),
                 element.place());
    if (verdict == Verdict::kRefused)
      element.reject(fmt::format("has the attribute \"{}\", which isn't taken. {}", name, row.reason));
  }

  void checkChild(const XmlElement& child, const GrammarRow& row) {
    const GrammarRow* found = findRow(grammar_.rows, row.name, child.tag);
    if (!found) {
      if (isExtension(child.tag)) return notes_.add(child.tag, "", child.place());
      child.reject(fmt::format("isn't an element that {} knows within <{}>.{}", grammar_.format, row.tag,
                               suggestion(child.tag, tagsWithin(row))));
    }
    switch (found->verdict) {
      case Verdict::kLooks:
        return;
      case Verdict::kIgnored:
        return noteIgnored(child, std::string(found->reason));
      case Verdict::kRefused:
        if (row.name == grammar_.defaults_row)
          return notes_.add(fmt::format("default {}", child.tag), "", child.place());
        child.reject(fmt::format("isn't taken. {}", found->reason));
      case Verdict::kRead:
        return check(child, *found);
    }
  }

  // Each of its parts by name.
  void noteIgnored(const XmlElement& element, const std::string& reason) {
    if (element.children.empty()) notes_.add(element.tag, reason, element.place());
    for (const XmlElement& child : element.children)
      notes_.add(fmt::format("{} {}", element.tag, child.tag), reason, child.place());
  }

  std::vector<std::string_view> tagsWithin(const GrammarRow& row) const {
    std::vector<std::string_view> tags;
    for (const GrammarRow& r : grammar_.rows) {
      if (has(r.parents, row.name)) tags.push_back(r.tag);
    }
    return tags;
  }

  const RobotGrammar& grammar_;
  ImportNotes& notes_;
};

}  // namespace

const GrammarRow* findRow(std::span<const GrammarRow> rows, std::string_view parent_row, std::string_view tag) {
  const auto row = std::find_if(rows.begin(), rows.end(), [&](const GrammarRow& r) {
    return r.tag == tag && (parent_row.empty() ? r.parents.empty() : has(r.parents, parent_row));
  });
  return row == rows.end() ? nullptr : &*row;
}

bool findAttribute(const GrammarRow& row, std::string_view attribute, Verdict& verdict) {
  const std::array lists = {std::pair{row.read, Verdict::kRead}, std::pair{row.looks, Verdict::kLooks},
                            std::pair{row.ignored, Verdict::kIgnored}, std::pair{row.refused, Verdict::kRefused}};
  const auto list = std::find_if(lists.begin(), lists.end(), [&](const auto& l) { return has(l.first, attribute); });
  if (list == lists.end()) return false;
  verdict = list->second;
  return true;
}

void refuseText(const XmlElement& element) {
  if (element.text.empty()) return;
  element.reject(fmt::format("holds the text \"{}\" between its elements. A robot's numbers stand in attributes.",
                             printable(element.text, kMostOfText)));
}

void checkGrammar(const RobotGrammar& grammar, const XmlElement& root, ImportNotes& notes) {
  Checker(grammar, notes).check(root, *findRow(grammar.rows, "", root.tag));
}

}  // namespace pincer::tasks
