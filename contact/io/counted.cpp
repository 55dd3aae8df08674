#include "pincer/contact/io/counted.h"

#include <fmt/format.h>

namespace pincer {

std::string counted(std::int64_t n, std::string_view thing) {
  if (n == 1) return fmt::format("1 {}", thing);
  if (thing.ends_with('x')) return fmt::format("{} {}ices", n, thing.substr(0, thing.size() - 2));
  return fmt::format("{} {}{}", n, thing, thing.ends_with("ch") ? "es" : "s");
}

}  // namespace pincer
