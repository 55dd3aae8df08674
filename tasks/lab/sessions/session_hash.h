// session_hash: 64 bits over all that a session keeps.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "pincer/tasks/run/session_store.h"

namespace pincer::tasks {

// 16 hexadecimal digits (fingerprint.h) over the finished trials, answers and kept ticks, times that were measured left
// out: equal for runs that are the same to the bit. NaNs are one value, and so are the two zeros, as in the store.
// `samples`: SessionWriter::samplesHash() of who has just written it; without it the kept ticks are read.
std::string sessionHash(const SessionReader& session, const std::optional<std::uint64_t>& samples = {});

}  // namespace pincer::tasks
