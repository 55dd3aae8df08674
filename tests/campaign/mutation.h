// mutation: a text or bytes with some harm done. The same draws give the same harm.
#pragma once
#include <string>
#include <vector>

#include "pincer/tests/support/random_numbers.h"

namespace pincer::campaign {

using tests::RandomNumbers;

// Strings, numbers, words, blanks and single characters; joined they are the text again.
std::vector<std::string> tokensOf(const std::string& text);

// Numbers at the ends of what a reader may meet.
const std::vector<std::string>& extremeNumbers();

// Bytes flipped, cut off, doubled, left out, put in.
std::string mutatedBytes(RandomNumbers& random, std::string bytes);

// Of a text with numbers (tables, meshes): tokens exchanged, numbers at their
// extremes, lines doubled or left out; or as bytes.
std::string mutatedText(RandomNumbers& random, const std::string& text);

// Of JSON: besides these, values of other types, keys doubled, renamed and huge,
// deep nesting, escapes, a byte order mark.
std::string mutatedJson(RandomNumbers& random, const std::string& text);

}  // namespace pincer::campaign
