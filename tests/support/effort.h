// effort: how many draws a random test makes. The same code runs for each, so a sanitized build,
// ten times as slow, makes a quarter of them.
#pragma once
#include <cstdlib>

// gcc says that it sanitizes by a macro, clang by a feature.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define PINCER_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define PINCER_SANITIZED 1
#endif
#endif
#ifndef PINCER_SANITIZED
#define PINCER_SANITIZED 0
#endif

namespace pincer::tests {

// `usual` draws, at least one; `with_time` as many if PINCER_LONG_TESTS is set.
inline int draws(int usual, int with_time = 1) {
  if (std::getenv("PINCER_LONG_TESTS") != nullptr) return usual * with_time;
  return PINCER_SANITIZED ? (usual + 3) / 4 : usual;
}

}  // namespace pincer::tests
