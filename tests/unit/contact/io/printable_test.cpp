// Text of others is shown and not obeyed.
#include "pincer/contact/io/printable.h"

#include <gtest/gtest.h>

#include "pincer/contact/io/counted.h"
#include "pincer/tests/support/random_numbers.h"

namespace pincer {
namespace {

using tests::RandomNumbers;

TEST(Printable, ShowsEscapeSequencesInPlaceOfObeyingThem) {
  EXPECT_EQ(printable("a\x1b[31mred\x07"), "a\\x1b[31mred\\x07");
  EXPECT_EQ(printable("tab\tline\nreturn\r"), "tab\\tline\\nreturn\\r");
  EXPECT_EQ(printable(std::string_view("nul\0here", 8)), "nul\\x00here");
  EXPECT_EQ(printable("\x7f"), "\\x7f");
  EXPECT_EQ(printable("\xc2\x9b"), "\\x9b");        // CSI as one character
  EXPECT_EQ(printable("\xe2\x80\xae"), "\\u202e");  // would turn what follows
  EXPECT_EQ(printable("\xe2\x80\xa8"), "\\u2028");  // a line separator
}

TEST(Printable, KeepsWhatPeopleWrite) {
  for (const char* text : {"", "s4_pinch.json", "größe µₛ ± 3", "日本語", "😀", "C:\\path", "\\x1b"})
    EXPECT_EQ(printable(text), text);
}

TEST(Printable, ShowsBytesThatAreNoUtf8) {
  EXPECT_EQ(printable("\xff"), "\\xff");
  EXPECT_EQ(printable("\xc3("), "\\xc3(");
  EXPECT_EQ(printable("\xc0\xaf"), "\\xc0\\xaf");                    // overlong
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80");           // half of a surrogate pair
  EXPECT_EQ(printable("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");  // beyond Unicode
  EXPECT_EQ(printable("\xe2\x82"), "\\xe2\\x82");                    // cut off
}

TEST(Printable, CutsLongTextBetweenCharacters) {
  EXPECT_EQ(printable(std::string(120, 'x')), std::string(120, 'x'));
  EXPECT_EQ(printable(std::string(121, 'x')), std::string(120, 'x') + "... (121 bytes)");
  std::string umlauts;
  for (int i = 0; i < 1000; ++i) umlauts += "ü";
  EXPECT_EQ(printable(umlauts, 2), "üü... (2000 bytes)");
}

TEST(Printable, MessagesKeepTheirLinesTheirBeginningAndTheirRemedy) {
  EXPECT_EQ(printableMessage("one\ntwo\x1b"), "one\ntwo\\x1b");
  const std::string long_one = "s.json:3: " + std::string(5'000'000, 'y') + " isn't known. Remove it.";
  const std::string shown = printableMessage(long_one);
  EXPECT_LE(shown.size(), kLongestMessage + 10);
  EXPECT_TRUE(shown.starts_with("s.json:3: yyy"));
  EXPECT_TRUE(shown.ends_with("yyy isn't known. Remove it."));
}

// Whatever the bytes: nothing that a terminal obeys is left, the length is bounded, and doing it twice changes nothing.
TEST(Printable, IsTotal) {
  RandomNumbers random(1);
  for (int n = 0; n < 20'000; ++n) {
    std::string text(static_cast<std::size_t>(random.below(300)), ' ');
    for (char& c : text) c = static_cast<char>(random.below(3) ? random.below(256) : 0xC0 + random.below(64));
    const std::string shown = printable(text, 400), message = printableMessage(text);
    EXPECT_EQ(printable(shown, 4 * 400), shown);
    EXPECT_EQ(printableMessage(message), message);
    for (const char c : shown) EXPECT_TRUE(static_cast<unsigned char>(c) >= 0x20 && c != 0x7f);
    EXPECT_LE(printable(text, 10).size(), 10 * 6 + 20u);
  }
}

TEST(Counted, SpeaksOfOneAsOfOne) {
  EXPECT_EQ(counted(1, "trial"), "1 trial");
  EXPECT_EQ(counted(0, "trial"), "0 trials");
  EXPECT_EQ(counted(2, "vertex"), "2 vertices");
  EXPECT_EQ(counted(1, "vertex"), "1 vertex");
  EXPECT_EQ(counted(3, "folded patch"), "3 folded patches");
}

}  // namespace
}  // namespace pincer
