#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>

#include "pincer/contact/io/input_file.h"
#include "pincer/contact/io/printable.h"
#include "pincer/tasks/run/files/builtin_files.h"
#include "pincer/tasks/run/robot/xml_tree.h"

namespace pincer::tasks {
namespace {

// 16 MB: some hundred times a robot of a hundred links. Bounds the memory that a mistaken file takes.
constexpr InputKind kXmlFile = {"a robot's XML file (docs/robots.md)", 16 * kMegabyte, true,
                                "Robots of a hundred links have some 100 kB; meshes belong into files of their own."};

class TreeBuilder {
 public:
  explicit TreeBuilder(const std::string& file) : file_(file) {}

  XmlElement build(const tinyxml2::XMLElement& from, int depth) {
    XmlElement element{from.Name(), {}, {}, {}, file_, from.GetLineNum()};
    if (++count_ > kMostXmlElements)
      element.reject(fmt::format("is one element too many: a file has at most {}.", kMostXmlElements));
    if (depth > kDeepestXml) element.reject(fmt::format("lies deeper than {} levels.", kDeepestXml));
    readAttributes(from, element);
    readChildren(from, element, depth);
    return element;
  }

 private:
  static void readAttributes(const tinyxml2::XMLElement& from, XmlElement& element) {
    for (const auto* attribute = from.FirstAttribute(); attribute; attribute = attribute->Next()) {
      element.attributes.push_back({attribute->Name(), attribute->Value()});
    }
  }

  void readChildren(const tinyxml2::XMLElement& from, XmlElement& element, int depth) {
    for (const auto* child = from.FirstChild(); child; child = child->NextSibling()) {
      if (const auto* inner = child->ToElement()) {
        element.children.push_back(build(*inner, depth + 1));
      } else if (child->ToText() && element.text.empty()) {
        element.text = child->Value();
      }
    }
  }

  std::string file_;
  int count_ = 0;
};

}  // namespace

const std::string* XmlElement::find(std::string_view name) const {
  const auto at =
      std::find_if(attributes.begin(), attributes.end(), [&](const XmlAttribute& a) { return a.name == name; });
  return at == attributes.end() ? nullptr : &at->value;
}

std::string XmlElement::place() const { return fmt::format("{}:{}", file, line); }

void XmlElement::reject(std::string_view problem) const {
  throw InputError(printableMessage(fmt::format("{}: <{}> {}", place(), tag, problem)));
}

XmlElement parseXml(std::string_view text, const std::string& name) {
  tinyxml2::XMLDocument document;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
    throw InputError(fmt::format(
        "{}:{}: isn't well-formed XML ({}). The file is cut off or was edited by hand: look at the element there.",
        name, document.ErrorLineNum(), tinyxml2::XMLDocument::ErrorIDToName(document.ErrorID())));
  }
  const tinyxml2::XMLElement* root = document.RootElement();
  if (!root) throw InputError(fmt::format("{}: has no element.", name));
  return TreeBuilder(name).build(*root, 1);
}

XmlElement readXml(const std::string& path) {
  for (const BuiltinFile& file : builtinFiles()) {
    if (file.path == path) return parseXml(file.text, path);
  }
  return parseXml(readInputFile(path, kXmlFile), path);
}

}  // namespace pincer::tasks
