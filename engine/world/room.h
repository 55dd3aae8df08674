// room: space for what a tick adds, in memory that was written to before: the first touch of a page takes
// microseconds, and a tick that meets many new contacts would pay for hundreds of them.
#pragma once
#include <cstddef>
#include <vector>

namespace pincer::engine {

template <class T>
void makeRoom(std::vector<T>& out, std::size_t count) {
  out.resize(count);
  out.clear();
}

}  // namespace pincer::engine
