#include "pincer/tasks/run/rollout/state_bytes.h"

#include <fmt/format.h>

#include <cstring>

#include "pincer/contact/error.h"
#include "pincer/tasks/run/session/build_info.h"

namespace pincer::tasks {
namespace {

// take(part) for every part of a state. The names are bound to all members: who adds one to a state is
// told here by the compiler to add it below.
template <class Grasp, class Take>
void eachPart(Grasp& grasp, const Take& take) {
  auto& [world, followed, fingers] = grasp;
  auto& [per_finger, colliders, gaps, trackers] = followed;
  auto& [time, tick, parts, h_last, bodies, driven_w_W, points, tree_q, tree_v, controls, drives, brakes, contacts,
         contact_count] = world;
  take(time), take(tick), take(parts), take(h_last), take(contact_count);
  take(bodies), take(driven_w_W), take(points), take(tree_q), take(tree_v), take(controls), take(drives), take(brakes),
      take(contacts), take(per_finger), take(colliders), take(gaps), take(trackers), take(fingers);
}

std::string heading() { return fmt::format("pincer state {} {}\n", kBuildInfo.version, kBuildInfo.sources); }

struct Writer {
  std::string& bytes;
  template <class Value>
  void operator()(const Value& value) const {
    static_assert(std::is_arithmetic_v<Value>);
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  template <class Item>
  void operator()(const std::vector<Item>& items) const {
    (*this)(static_cast<std::uint64_t>(items.size()));
    bytes.append(reinterpret_cast<const char*>(items.data()), items.size() * sizeof(Item));
  }
};

struct Reader {
  std::string_view& bytes;
  void take(void* to, std::size_t size) const {
    if (size > bytes.size()) throw InputError("a pickled state is cut off. Pickle it again.");
    std::memcpy(to, bytes.data(), size);
    bytes.remove_prefix(size);
  }
  template <class Value>
  void operator()(Value& value) const {
    take(&value, sizeof value);
  }
  template <class Item>
  void operator()(std::vector<Item>& items) const {
    std::uint64_t count = 0;
    (*this)(count);
    if (count != items.size())
      throw InputError("a pickled state is one of another model. Give it the model that it was pickled with.");
    // Items are numbers and fixed-size vectors and quaternions of numbers; Eigen's have
    // constructors, for which alone g++ would warn.
    take(static_cast<void*>(items.data()), items.size() * sizeof(Item));
  }
};

}  // namespace

std::string bytesOf(const SceneState& state) {
  if (state.baselines)
    throw InputError("a state whose fingers are rendered as published (\"method\") can't be pickled; copy() it.");
  std::string bytes = heading();
  eachPart(state.grasp, Writer{bytes});
  Writer{bytes}(state.held);
  return bytes;
}

void setFromBytes(SceneState& state, std::string_view bytes) {
  const std::string mine = heading();
  if (!bytes.starts_with(mine)) {
    const std::string_view theirs = bytes.substr(0, std::min<std::size_t>(bytes.find('\n'), 60));
    throw InputError(
        fmt::format("a pickled state is of another build ({}; this is {}). Bits may differ, so it isn't read.", theirs,
                    mine.substr(0, mine.size() - 1)));
  }
  bytes.remove_prefix(mine.size());
  SceneState read = state;
  eachPart(read.grasp, Reader{bytes});
  Reader{bytes}(read.held);
  if (!bytes.empty())
    throw InputError("a pickled state is longer than one of this model. Give it the model that it was pickled with.");
  state = std::move(read);
}

}  // namespace pincer::tasks
