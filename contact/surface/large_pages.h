// large_pages: asks the system to keep an array in pages of 2 MB instead of 4 KB. Where queries read it here and
// there, as on a mesh of a million triangles, most of such a read was the walk through the page table to find it.
// No answer depends on what the system grants.
#pragma once
#include <cstddef>
#include <vector>

namespace pincer::contact {

// Asks for large pages under the memory that lies there now, as far as it fills whole ones; takes some 5 ms per MB.
// Memory that isn't granted is left as it is.
void preferLargePages(const void* begin, std::size_t bytes);

template <class T>
void preferLargePages(const std::vector<T>& array) {
  preferLargePages(array.data(), array.size() * sizeof(T));
}

}  // namespace pincer::contact
