#include "pincer/contact/surface/large_pages.h"

#include <sys/mman.h>

#include <cstdint>

namespace pincer::contact {

void preferLargePages(const void* begin, std::size_t bytes) {
  constexpr std::uintptr_t kPage = std::uintptr_t{1} << 21;  // bytes: x86-64's next larger page
  constexpr int kCollapse = 25;  // MADV_COLLAPSE: at once (Linux 6.1); not every C library has the name
  const auto first = reinterpret_cast<std::uintptr_t>(begin), end = (first + bytes) / kPage * kPage;
  const std::uintptr_t whole = (first + kPage - 1) / kPage * kPage;
  if (whole >= end) return;
  void* const pages = reinterpret_cast<void*>(whole);
  if (::madvise(pages, end - whole, MADV_HUGEPAGE) == 0) ::madvise(pages, end - whole, kCollapse);
}

}  // namespace pincer::contact
