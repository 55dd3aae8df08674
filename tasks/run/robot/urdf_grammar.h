// urdf_grammar: the elements and attributes of URDF, and for each of them what the importer does with it.
//
// The names are those of the schema that ROS publishes (urdf.xsd of urdfdom), and extensions that files have.
#pragma once
#include "pincer/tasks/run/robot/robot_grammar.h"

namespace pincer::tasks::urdf {

std::span<const GrammarRow> rows();

}  // namespace pincer::tasks::urdf
