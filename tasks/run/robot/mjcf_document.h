// mjcf_document: an MJCF file with its includes put in place, its classes of defaults, its compiler's settings, and
// every element and attribute held against the grammar (mjcf_grammar.h).
#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "pincer/tasks/run/robot/import_notes.h"
#include "pincer/tasks/run/robot/mjcf_grammar.h"
#include "pincer/tasks/run/robot/model_folder.h"
#include "pincer/tasks/run/robot/xml_tree.h"

namespace pincer::tasks::mjcf {

enum class InertiaFromGeoms { kNever, kAlways, kWhereMissing };

// Of all compiler elements, whatever their place.
struct Compiler {
  bool degrees = true, autolimits = true, balance_inertia = false, strip_path = false;
  std::string euler_order = "xyz", mesh_folder;
  InertiaFromGeoms inertia_from_geoms = InertiaFromGeoms::kWhereMissing;
  int first_inertia_group = 0, last_inertia_group = 5;
  double least_mass = 0, least_inertia = 0, total_mass = -1;
};

// A class of defaults: for each kind of element the attributes that its elements of
// this class have unless they say otherwise.
struct DefaultClass {
  std::string name;
  int parent = -1;  // whose values it inherits
  std::map<std::string, std::vector<XmlElement>, std::less<>>
      elements;  // by the row's name; of actuators by "actuator", in the file's order
};

struct Document {
  std::string file;
  XmlElement root;  // the element mujoco, includes in place
  Compiler compiler;
  std::vector<DefaultClass> classes;  // the first one is "main"
  ModelFolder folder;
  ImportNotes notes;
};

// Throws InputError: not XML, no element mujoco, an element or attribute that MJCF doesn't have or that is refused, an
// include that is missing, outside of the folder or in a circle, a class of no or of two names.
Document readDocument(const std::string& path, const std::vector<std::string>& allowed_folders);

// The index of a class. Throws InputError at `element`, with a did-you-mean.
int classNamed(const Document& document, const std::string& name, const XmlElement& element);

// All elements of a section ("worldbody", "actuator", ...), which may stand in several places.
std::vector<const XmlElement*> sections(const Document& document, std::string_view tag);

// The row of an element that stands in `parent_row`, once it was checked.
inline std::string_view rowName(std::string_view parent_row, const XmlElement& element) {
  return rowOf(parent_row, element.tag)->name;
}

}  // namespace pincer::tasks::mjcf
