// error_of: what an InputError says; empty if nothing was thrown.
#pragma once
#include <functional>
#include <string>

#include "pincer/contact/error.h"

namespace pincer::tests {

inline std::string errorOf(const std::function<void()>& act) {
  try {
    act();
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

// Of whatever exception.
inline std::string problemOf(const std::function<void()>& act) {
  try {
    act();
  } catch (const std::exception& e) {
    return e.what();
  }
  return "";
}

}  // namespace pincer::tests
