// assert: two of the three tiers of errors (docs/extending.md); the third, a user's bad
// input, is an InputError (contact/error.h).
//
//   PINCER_ASSERT(condition)           what pincer's own code must guarantee: unit normals, sorted ids, sizes, cones
//   PINCER_DEMAND(condition, message)  what the calling program must guarantee, at the
//                                      API: sizes of spans, indices, order of calls
//
// Either ends the program with one sentence on stderr and abort(): an error in the program can't be handled by
// it, and a force worked out from wrong memory must not reach a hand. An arm to which no more commands come
// lets go by itself (docs/devices/setup.md).
#pragma once

namespace pincer {

// Prints the place, the condition and, if it isn't null, the message; then calls abort().
[[noreturn, gnu::cold]] void endOnBrokenPromise(const char* file, int line, const char* condition,
                                                const char* message) noexcept;

}  // namespace pincer

// In every build: a comparison per call, so not in inner loops. `message`: a sentence
// for the caller, which says what must hold.
#define PINCER_DEMAND(condition, message) \
  (static_cast<bool>(condition) ? void() : ::pincer::endOnBrokenPromise(__FILE__, __LINE__, #condition, message))

// In debug and sanitized builds (CMake: PINCER_ASSERTS). Elsewhere the condition is compiled, so
// that it stays correct, but never evaluated.
#ifdef PINCER_ASSERTS
#define PINCER_ASSERT(...) \
  (static_cast<bool>(__VA_ARGS__) ? void() : ::pincer::endOnBrokenPromise(__FILE__, __LINE__, #__VA_ARGS__, nullptr))
#else
#define PINCER_ASSERT(...) static_cast<void>(sizeof(static_cast<bool>(__VA_ARGS__)))
#endif
