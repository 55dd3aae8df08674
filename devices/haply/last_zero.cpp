#include "pincer/devices/haply/last_zero.h"

#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <ctime>

#include "pincer/devices/haply/haply_messages.h"

namespace pincer::devices::haply {
namespace {

// Signals that end the program with a force still commanded.
constexpr std::array kDeadly{SIGSEGV, SIGBUS, SIGFPE, SIGABRT};
constexpr std::size_t kHeader = 8;      // at most: text, final, masked; length; a mask of zeros
constexpr std::size_t kShortest = 126;  // length that needs 16 bits; a shorter one may not have them (RFC 6455, 5.2)

struct Slot {
  std::atomic<bool> taken{false}, writing{false};
  std::atomic<int> descriptor{-1};
  std::atomic<std::size_t> size{0};
  std::array<char, kMostCommand + kHeader> frame{};
};
// A handler of signals has nothing but what is global.
std::array<Slot, 4> slots;
std::atomic<bool> dying{false};

void sayZeros() {
  for (Slot& slot : slots) {
    const int descriptor = slot.descriptor.load();
    if (descriptor < 0) continue;
    if (slot.writing.load()) {
      ::shutdown(descriptor, SHUT_RDWR);
    } else {
      [[maybe_unused]] const auto sent =
          ::send(descriptor, slot.frame.data(), slot.size.load(), MSG_NOSIGNAL | MSG_DONTWAIT);
    }
  }
}

void pauseMs(long ms) {
  const timespec time{0, ms * 1'000'000};
  ::nanosleep(&time, nullptr);
}

// The first zero may overtake a force that is being sent, the second doesn't. A service that loses its client while it
// answers may not read on: so it gets time to.
extern "C" void pincerOnDeath(int signal) {
  dying = true;
  for (int i = 0; i < 2; ++i) {
    pauseMs(1);
    sayZeros();
    pauseMs(9);
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
  const bool is_long = text.size() >= kShortest;
  slot.frame.fill(0);
  slot.frame[0] = '\x81';
  slot.frame[1] = static_cast<char>(0x80 | (is_long ? kShortest : text.size()));
  if (is_long)
    slot.frame[2] = static_cast<char>(text.size() >> 8), slot.frame[3] = static_cast<char>(text.size() & 255);
  const std::size_t header = is_long ? kHeader : kHeader - 2;
  std::copy(text.begin(), text.end(), slot.frame.begin() + static_cast<std::ptrdiff_t>(header));
  slot.size = text.size() + header;
  slot.descriptor = descriptor;
}

void LastZero::writing(bool now) {
  if (slot_ >= 0) slots[static_cast<std::size_t>(slot_)].writing = now;
}

bool LastZero::isLast() { return dying.load(); }

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
