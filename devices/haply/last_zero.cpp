#include "pincer/devices/haply/last_zero.h"

#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdint>

#include "pincer/devices/haply/haply_messages.h"

namespace pincer::devices::haply {
namespace {

constexpr std::array kDeadly{SIGSEGV, SIGBUS, SIGFPE, SIGABRT};
constexpr std::size_t kHeader = 8;  // text, final, masked, 16 bits of length, a mask of zeros

struct Slot {
  std::atomic<bool> taken{false}, writing{false};
  std::atomic<int> descriptor{-1};
  std::atomic<std::size_t> size{0};
  std::array<char, kMostCommand + kHeader> frame{};
};
// A handler of signals has nothing but what is global.
std::array<Slot, 4> slots;

extern "C" void pincerOnDeath(int signal) {
  for (Slot& slot : slots) {
    const int descriptor = slot.descriptor.load();
    if (descriptor < 0) continue;
    if (slot.writing.load()) {
      ::shutdown(descriptor, SHUT_RDWR);
    } else {
      [[maybe_unused]] const auto sent = ::send(descriptor, slot.frame.data(), slot.size.load(), MSG_NOSIGNAL | MSG_DONTWAIT);
    }
  }
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

}  // namespace

LastZero::LastZero() : slot_(-1) {
  for (std::size_t i = 0; i < slots.size() && slot_ < 0; ++i) {
    if (!slots[i].taken.exchange(true)) slot_ = static_cast<int>(i);
  }
}

LastZero::~LastZero() {
  set(-1, {});
  if (slot_ >= 0) slots[static_cast<std::size_t>(slot_)].taken = false;
}

void LastZero::set(int descriptor, std::string_view text) {
  if (slot_ < 0) return;
  Slot& slot = slots[static_cast<std::size_t>(slot_)];
  slot.descriptor = -1;
  if (descriptor < 0 || text.empty() || text.size() > kMostCommand) return;
  slot.frame = {'\x81', '\xfe', static_cast<char>(text.size() >> 8), static_cast<char>(text.size() & 255)};
  std::copy(text.begin(), text.end(), slot.frame.begin() + kHeader);
  slot.size = text.size() + kHeader;
  slot.descriptor = descriptor;
}

void LastZero::writing(bool now) {
  if (slot_ >= 0) slots[static_cast<std::size_t>(slot_)].writing = now;
}

void LastZero::install() {
  for (const int signal : kDeadly) {
    struct sigaction now {};
    if (::sigaction(signal, nullptr, &now) != 0 || now.sa_handler != SIG_DFL) continue;
    struct sigaction deadly {};
    deadly.sa_handler = pincerOnDeath;
    deadly.sa_flags = SA_NODEFER;
    ::sigaction(signal, &deadly, nullptr);
  }
}

}  // namespace pincer::devices::haply
