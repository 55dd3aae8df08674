#include "pincer/tests/emulation/usbfs_interpose.h"

#include <array>
#include <atomic>
#include <map>

namespace pincer::emulation {
namespace {

constexpr int kMostFds = 4096;

// The hot path asks one atomic; the shared pointers keep a device alive until its descriptor is closed.
struct Table {
  std::mutex mutex;
  std::map<std::string, std::shared_ptr<UsbfsDevice>> nodes;
  std::map<int, std::shared_ptr<UsbfsDevice>> owners;
  std::array<std::atomic<UsbfsDevice*>, kMostFds> fds{};
  std::atomic<bool> any{false}, denied{false};
};
Table& table() {
  static Table the_table;
  return the_table;
}

bool answersUsbfs() { return table().any; }

UsbfsDevice* usbfsAt(int fd) {
  return table().any && fd >= 0 && fd < kMostFds ? table().fds[static_cast<std::size_t>(fd)].load() : nullptr;
}

int openUsbfs(const char* node) {
  Table& t = table();
  const std::lock_guard lock(t.mutex);
  const auto found = t.nodes.find(node);
  if (found == t.nodes.end() || !found->second) return -ENOENT;
  if (t.denied) return -EACCES;
  int fd = -1;
  if (const int error = found->second->open(fd); error < 0) return error;
  t.owners[fd] = found->second;
  t.fds[static_cast<std::size_t>(fd)] = found->second.get();
  return fd;
}

void closeUsbfs(int fd) {
  Table& t = table();
  std::shared_ptr<UsbfsDevice> owner;
  {
    const std::lock_guard lock(t.mutex);
    t.fds[static_cast<std::size_t>(fd)] = nullptr;
    owner = t.owners[fd];
    t.owners.erase(fd);
  }
  owner->closed();
}

}  // namespace

void attachUsbfs(const std::string& node, std::shared_ptr<UsbfsDevice> device) {
  Table& t = table();
  const std::lock_guard lock(t.mutex);
  device ? void(t.nodes[node] = std::move(device)) : void(t.nodes.erase(node));
  t.any = true;
}

void denyUsbfs(bool deny) { table().denied = deny; }

}  // namespace pincer::emulation

#include "pincer/tests/emulation/usbfs_symbols.h"
