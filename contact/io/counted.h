// counted: a number of things as English says it: "1 trial", "2 trials", "3 vertices".
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

namespace pincer {

// `thing` in the singular; its plural ends with s, that of a word on -x with -ices
// ("vertex"), that of one on -ch with -es ("patch").
std::string counted(std::int64_t n, std::string_view thing);

}  // namespace pincer
