// print: what the program says. Work never ends because nobody listens: a stream that can't be written (a full disk, a
// closed pipe) keeps that in mind, and runApp() says so at the end.
#pragma once
#include <fmt/format.h>

#include <cstdio>
#include <iterator>
#include <utility>

namespace pincer::tasks {

// Throws nothing but std::bad_alloc, and that only for long texts.
template <class... Args>
void print(std::FILE* stream, fmt::format_string<Args...> format, Args&&... args) {
  fmt::memory_buffer text;
  fmt::format_to(std::back_inserter(text), format, std::forward<Args>(args)...);
  std::fwrite(text.data(), 1, text.size(), stream);
}

template <class... Args>
void print(fmt::format_string<Args...> format, Args&&... args) {
  pincer::tasks::print(stdout, format, std::forward<Args>(args)...);  // not fmt's
}

}  // namespace pincer::tasks
