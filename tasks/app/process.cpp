#include "pincer/tasks/app/process.h"

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>

#include "pincer/tasks/app/app.h"
#include "pincer/tasks/app/interrupt.h"

namespace pincer::tasks {
namespace {

// Opened the wrong way round: reading 0 and writing 1 or 2 fail, as they would have.
void openStandardStreams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(stream, F_GETFD) != -1) continue;
    [[maybe_unused]] const int lowest = ::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
  }
}

// Where memory ended inside of a function that can't throw. Nothing of the stack is undone.
[[noreturn]] void endWithoutUnwinding() noexcept {
  bool memory_ended = false;
  if (const std::exception_ptr cause = std::current_exception()) {
    try {
      std::rethrow_exception(cause);
    } catch (const std::bad_alloc&) {
      memory_ended = true;
    } catch (const std::exception& error) {
      complain(error.what());
    } catch (...) {
    }
  } else {  // not even the exception could be made
    void* some = std::malloc(1 << 12);
    memory_ended = some == nullptr;
    std::free(some);
  }
  if (!memory_ended) std::abort();
  complain(kNotEnoughMemory);
  std::_Exit(kExitBadInput);
}

}  // namespace

void sayWhenMemoryEnds() noexcept { std::set_terminate(endWithoutUnwinding); }

void prepareProcess() {
  sayWhenMemoryEnds();
  openStandardStreams();
  handleSignals();
}

void complain(std::string_view what) noexcept {
  const auto say = [](std::string_view text) { std::fwrite(text.data(), 1, text.size(), stderr); };
  say("pincer: ");
  say(what);
  say("\n");
}

StandardOutputAside::StandardOutputAside() {
  std::fflush(stdout);
  kept_ = ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3);
  if (kept_ >= 0) ::dup2(STDERR_FILENO, STDOUT_FILENO);
}

StandardOutputAside::~StandardOutputAside() {
  std::fflush(stdout);
  if (kept_ < 0) return;
  ::dup2(kept_, STDOUT_FILENO);
  ::close(kept_);
}

}  // namespace pincer::tasks
