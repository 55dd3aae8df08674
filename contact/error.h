// error: what pincer throws when input is wrong. The message is a sentence for a
// person: place, value, allowed range, remedy.
#pragma once
#include <stdexcept>
#include <string>

namespace pincer {

// Bad input: a file, a scene, a value (exit code 3 of the program). Never thrown by the tick.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace pincer
