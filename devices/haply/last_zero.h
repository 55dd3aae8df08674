// last_zero: a program that dies of SIGSEGV, SIGBUS, SIGFPE or SIGABRT sends
// Haply's service one more message: zero force.
//
// The message is a ready-made WebSocket frame, so that the handler of the signal does nothing but send(), twice within
// 20 ms; where another frame is half sent it shuts the connection down instead. Then the signal does what it always
// does. SIGKILL and SIGSTOP can't be handled.
#pragma once
#include <atomic>
#include <string_view>

namespace pincer::devices::haply {

// The one of a connection, for as long as it lives; at most 4 at once, further ones do nothing.
class LastZero {
 public:
  LastZero();
  ~LastZero();
  LastZero(const LastZero&) = delete;
  LastZero& operator=(const LastZero&) = delete;

  // `text` is sent to `descriptor`; a negative one, or a text above kMostCommand, is none.
  void set(int descriptor, std::string_view text);
  // Around every write of a frame.
  void writing(bool now);

  // True once the program dies: nobody else may send any more.
  static bool isLast();
  // Handlers for the four signals, but for those that have one already. For a
  // program's main(), or whoever opens motors in one.
  static void install();

 private:
  int slot_;
};

}  // namespace pincer::devices::haply
