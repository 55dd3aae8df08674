// columns: numbers over time, quantised and as differences, so that what rests costs nothing once it is compressed.
//
//   column   low, step   two floats, little-endian
//            codes       only if step > 0: per value the difference to the code before (0 before the first), modulo
//                        2^16, first all low bytes, then all high ones
//   value    low + step code, code 0 .. 65534; 65535: absent
//
// A value comes back to within half a step of 1/65534 of the column's range, and a float's rounding of `low`. Values
// that aren't finite as floats are absent.
#pragma once
#include <cstdint>
#include <span>
#include <string>

namespace pincer::tasks {

void appendColumn(std::string& bytes, std::span<const double> values);

// Indices as differences to the one before, 4 bytes each, little-endian: first all lowest bytes, then the next.
void appendIndices(std::string& bytes, std::span<const std::uint32_t> indices);

}  // namespace pincer::tasks
