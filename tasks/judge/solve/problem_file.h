// problem_file: contact problems as text, one a file: what public sets are rewritten to, and other engines can dump.
//
//   contacts n
//   mu    n numbers
//   q     3 n numbers, rows t1, t2, n per contact
//   W k   then k lines `row column value`: the lower triangle, what isn't named is 0
//
// Docs: docs/engine.md, "A problem of one's own".
#pragma once
#include <string>

#include "pincer/engine/dense_problem.h"

namespace pincer::tasks {

constexpr int kMostProblemContacts = 1024;  // some minutes, and 300 MB

// Throws InputError "file:line: ..." for what isn't of this form.
engine::DenseProblem readContactProblem(const std::string& path);

}  // namespace pincer::tasks
