// tree_walk: where a walk through a tree has come to, so that it may stop and be carried on.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

namespace pincer::contact {

struct TreeWalk {
  static constexpr std::size_t kMostWaiting = 64;  // nodes: three per level at most, of at most sixteen levels

  std::array<std::int32_t, kMostWaiting> waiting{};  // to be visited, the next one last: 0 is the root
  std::size_t size = 1;

  bool isOver() const { return size == 0; }
};

constexpr int kWholeWalk = 1 << 30;  // visits: more than any tree has

}  // namespace pincer::contact
