// xml_tree: an XML file as a tree of elements, each with the file and line where it stands.
//
// Refused, with file and line: what isn't XML (an attribute given twice, too), more than kMostXmlElements elements,
// more than kDeepestXml levels. Files are regular files of at most 16 MB.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "pincer/contact/error.h"

namespace pincer::tasks {

constexpr int kMostXmlElements = 100000;  // of one file
constexpr int kDeepestXml = 90;           // tinyxml2 itself ends at 100

struct XmlAttribute {
  std::string name, value;
};

struct XmlElement {
  std::string tag;
  std::vector<XmlAttribute> attributes;  // in the file's order
  std::vector<XmlElement> children;
  std::string text;  // the first one between its elements; checkGrammar (robot_grammar.h) refuses it where it matters
  std::string file;
  int line = 0;

  const std::string* find(std::string_view name) const;  // an attribute's value; null: there is none
  std::string place() const;                             // "file:line"
  // Throws InputError: "file:line: tag problem".
  [[noreturn]] void reject(std::string_view problem) const;
};

// The root element of a file, or of a robot that the program carries (builtin_files.h). Throws InputError.
XmlElement readXml(const std::string& path);
// The same from text; `name` stands for the file in messages.
XmlElement parseXml(std::string_view text, const std::string& name);

}  // namespace pincer::tasks
