// spelling: the word that somebody probably meant.
#pragma once
#include <span>
#include <string>
#include <string_view>

namespace pincer::tasks {

// Least number of letters to insert, delete, replace or swap with their neighbour that turns `a` into `b`; a metric.
// Source: F. J. Damerau, Comm. ACM 7(3) (1964) 171-176; the table after R. Lowrance,
// R. A. Wagner, J. ACM 22(2) (1975) 177-183.
int editDistance(std::string_view a, std::string_view b);

// The closest of `candidates`, empty if none is within a third of the word's length (at least 1, at most 3 edits).
// Looks only at candidates whose length is that close: their number, not the word's length, says how long it takes.
std::string_view closestWord(std::string_view word, std::span<const std::string_view> candidates);

// " Did you mean "mass"?", or the list of candidates (the first 30, if any) when none is close.
std::string suggestion(std::string_view word, std::span<const std::string_view> candidates);

}  // namespace pincer::tasks
