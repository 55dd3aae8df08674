// mjcf_grammar: the elements and attributes of MJCF, and for each of them what the importer does with it.
//
// The names are those of the grammar that MuJoCo publishes (mjcf.schema, August 2026).
#pragma once
#include "pincer/tasks/run/robot/robot_grammar.h"

namespace pincer::tasks::mjcf {

std::span<const GrammarRow> rows();

inline const GrammarRow* rowOf(std::string_view parent_row, std::string_view tag) {
  return findRow(rows(), parent_row, tag);
}

}  // namespace pincer::tasks::mjcf
