// changed_json: JSON texts with bytes changed, put in, doubled and taken out, by chance. Some are still JSON.
#pragma once
#include <random>
#include <string>

namespace pincer::devices::emulate {

// `text` with 1 to `most` changes; it may become empty.
std::string changedJson(std::string text, std::size_t most, std::mt19937_64& random);

}  // namespace pincer::devices::emulate
