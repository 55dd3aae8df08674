// mjcf_replicate: the copies that the element "replicate" asks for, written out.
#pragma once
#include "pincer/tasks/run/robot/mjcf_document.h"

namespace pincer::tasks::mjcf {

// Puts frames in place of each "replicate" below `element`, one for each copy: moved and turned by "offset" and
// "euler" from the copy before, names of what is within followed by "sep" and the copy's number. Throws InputError:
// a count below 1, text that is no number, more elements than a file may have.
void writeCopiesOut(const Compiler& compiler, XmlElement& element);

}  // namespace pincer::tasks::mjcf
