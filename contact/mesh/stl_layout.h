// stl_layout: sizes of a binary STL file's parts [bytes].
#pragma once
#include <cstddef>

namespace pincer::contact {

constexpr std::size_t kStlHeader = 80;            // any text that doesn't begin with "solid"
constexpr std::size_t kStlHead = kStlHeader + 4;  // and the number of facets
constexpr std::size_t kStlFacet = 4 * 3 * 4 + 2;  // normal and three corners in single precision, two of attributes

}  // namespace pincer::contact
