// slot: the index that a number of a link, a coordinate or a column is.
#pragma once
#include <cstddef>

namespace pincer::engine {

inline std::size_t slot(int i) { return static_cast<std::size_t>(i); }

}  // namespace pincer::engine
