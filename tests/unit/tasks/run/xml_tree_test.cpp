// XML files of robots as trees: what is in them, each with its line, and a sentence for what isn't taken.
#include "pincer/tasks/run/robot/xml_tree.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "pincer/contact/io/input_file.h"
#include "pincer/contact/io/printable.h"
#include "pincer/tasks/run/robot/robot_grammar.h"
#include "pincer/tests/support/error_of.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

std::string complaint(const std::string& text) {
  return tests::errorOf([&] { parseXml(text, "robot.xml"); });
}

// Elements within each other, `levels` of them.
std::string nested(int levels) {
  std::string text;
  for (int i = 0; i < levels; ++i) text += "<a>";
  for (int i = 0; i < levels; ++i) text += "</a>";
  return text;
}

TEST(XmlTree, KeepsTagsAttributesAndTheirOrder) {
  const XmlElement root =
      parseXml("<!-- c --><a x=\"1\" w='2 &lt; 3'>\n  <b/>\n  <c y=\"\"/><!-- d -->\n</a>", "robot.xml");
  EXPECT_EQ(root.tag, "a");
  ASSERT_EQ(root.attributes.size(), 2u);
  EXPECT_EQ(root.attributes[0].name, "x");
  EXPECT_EQ(root.attributes[1].value, "2 < 3");
  ASSERT_EQ(root.children.size(), 2u);
  EXPECT_EQ(root.children[0].tag, "b");
  EXPECT_TRUE(root.children[0].attributes.empty());
  ASSERT_NE(root.children[1].find("y"), nullptr);
  EXPECT_EQ(*root.children[1].find("y"), "");
  EXPECT_EQ(root.find("y"), nullptr);
  EXPECT_EQ(root.find("w"), &root.attributes[1].value);
}

TEST(XmlTree, TellsEachElementsFileAndLine) {
  const XmlElement root = parseXml("<a>\n  <b/>\n\n  <c>\n<d/></c></a>", "robot.xml");
  EXPECT_EQ(root.place(), "robot.xml:1");
  EXPECT_EQ(root.children[0].place(), "robot.xml:2");
  EXPECT_EQ(root.children[1].children[0].place(), "robot.xml:5");
  EXPECT_EQ(tests::errorOf([&] { root.children[0].reject("is blue."); }), "robot.xml:2: <b> is blue.");
}

TEST(XmlTree, RefusesWhatIsntXml) {
  for (const char* text : {"<a>", "<a></b>", "<a x=1/>", "<a x=\"1\" x=\"2\"/>", "<a", "plain"})
    EXPECT_NE(complaint(text).find("robot.xml:"), std::string::npos) << text;
  EXPECT_NE(complaint("<a>\n<b></c></a>").find("robot.xml:2: isn't well-formed XML"), std::string::npos)
      << complaint("<a>\n<b></c></a>");
  EXPECT_EQ(complaint("<!-- nothing -->"), "robot.xml: has no element.");
}

TEST(XmlTree, KeepsTheFirstTextBetweenElements) {
  const XmlElement root = parseXml("<a>\n  <b>1 2 3<c/>4</b></a>", "robot.xml");
  EXPECT_EQ(root.text, "");
  EXPECT_EQ(root.children[0].text, "1 2 3");
}

TEST(RobotGrammar, RefusesTextBetweenElements) {
  const auto said = [](const std::string& text) {
    return tests::errorOf([&] { refuseText(parseXml(text, "robot.xml")); });
  };
  EXPECT_NE(said("<b>1 2 3</b>").find("robot.xml:1: <b> holds the text \"1 2 3\""), std::string::npos);
  const std::string long_one = said("<a>" + std::string(60, 'x') + "</a>");
  EXPECT_NE(long_one.find(printable(std::string(60, 'x'), 40)), std::string::npos) << long_one;
  EXPECT_NE(said("<a>\x1b[2J</a>").find("\\x1b[2J"), std::string::npos) << "shown, not obeyed by a terminal";
}

TEST(XmlTree, TakesAsManyLevelsAsItSaysAndNoMore) {
  EXPECT_EQ(complaint(nested(kDeepestXml)), "");
  EXPECT_EQ(complaint(nested(kDeepestXml + 1)),
            fmt::format("robot.xml:1: <a> lies deeper than {} levels.", kDeepestXml));
  EXPECT_NE(complaint(nested(100000)), "") << "the stack would not bear it";
}

TEST(XmlTree, TakesAsManyElementsAsItSaysAndNoMore) {
  std::string many = "<a>";
  for (int i = 1; i < kMostXmlElements; ++i) many += "<b/>";
  EXPECT_EQ(complaint(many + "</a>"), "");
  EXPECT_NE(complaint(many + "<b/></a>").find("one element too many"), std::string::npos);
}

TEST(XmlTree, ReadsAFileAndRefusesOneThatIsntText) {
  const tests::TemporaryDirectory folder;
  std::ofstream(folder / "robot.xml") << "<a>\n<b/></a>";
  EXPECT_EQ(readXml(folder / "robot.xml").children[0].place(), folder / "robot.xml" + ":2");
  std::ofstream(folder / "nul.xml") << "<a>" << '\0' << "</a>";
  const std::string nul = tests::errorOf([&] { readXml(folder / "nul.xml"); });
  EXPECT_NE(nul.find("NUL"), std::string::npos) << nul;
  EXPECT_NE(tests::errorOf([&] { readXml(folder / "none.xml"); }), "");
}

TEST(XmlTree, RefusesAFileOfMoreThanSixteenMegabytesUnread) {
  const tests::TemporaryDirectory folder;
  const std::string path = folder / "huge.xml";
  std::ofstream{path};
  std::filesystem::resize_file(path, 16 * kMegabyte + 1);
  const std::string said = tests::errorOf([&] { readXml(path); });
  EXPECT_NE(said.find("16"), std::string::npos) << said;
  EXPECT_EQ(said.find("NUL"), std::string::npos) << said;
}

}  // namespace
}  // namespace pincer::tasks
