#include "pincer/tasks/run/files/strict_json.h"
#include "pincer/tasks/run/robot/xml_tree.h"
#include "pincer/tests/fuzz/demand.h"
#include "pincer/tests/fuzz/targets.h"

namespace pincer::fuzz {
namespace {

void demandNested(const tasks::XmlElement& element, int depth) {
  demand(!element.tag.empty() && element.line > 0, "an element has a tag and a line");
  demand(depth <= tasks::kDeepestXml, "elements nest no deeper than the limit");
  for (const tasks::XmlElement& child : element.children) demandNested(child, depth + 1);
}

}  // namespace

void json(Bytes input) {
  readsOrRefuses([&] { tasks::parseJson(textOf(input), "fuzz.json"); });
}

void xml(Bytes input) {
  readsOrRefuses([&] { demandNested(tasks::parseXml(textOf(input), "fuzz.xml"), 1); });
}

}  // namespace pincer::fuzz
