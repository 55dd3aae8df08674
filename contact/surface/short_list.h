// short_list: a list of at most N plain values, kept in place; what isn't in it isn't initialised.
#pragma once
#include <cstddef>
#include <memory>
#include <type_traits>

#include "pincer/contact/assert.h"

namespace pincer::contact {

template <class T, std::size_t N>
class ShortList {
 public:
  static_assert(std::is_trivially_destructible_v<T>);
  ShortList() = default;
  ShortList(const ShortList&) = delete;
  ShortList& operator=(const ShortList&) = delete;

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  bool isFull() const { return size_ == N; }
  // Requires room.
  void push_back(const T& value) {
    PINCER_ASSERT(!isFull());
    std::construct_at(begin() + size_++, value);
  }
  void pop_back() {
    PINCER_ASSERT(!empty());
    --size_;
  }
  void clear() { size_ = 0; }

  T* begin() { return reinterpret_cast<T*>(bytes_); }
  T* end() { return begin() + size_; }
  const T* begin() const { return reinterpret_cast<const T*>(bytes_); }
  const T* end() const { return begin() + size_; }
  T& front() { return *begin(); }
  const T& front() const { return *begin(); }

 private:
  alignas(T) std::byte bytes_[N * sizeof(T)];
  std::size_t size_ = 0;
};

}  // namespace pincer::contact
