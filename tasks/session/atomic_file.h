// atomic_file: a text or binary file that appears whole or not at all: written beside its place as `<path>.part`, then renamed.
//
// Errors: InputError with path, cause and remedy; the partial file is removed.
#pragma once
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

namespace pincer::tasks {

class AtomicFile {
 public:
  explicit AtomicFile(std::string path);
  AtomicFile(AtomicFile&&) = delete;
  ~AtomicFile();  // without commit(): nothing is left
  void write(std::string_view bytes);
  void commit();  // an older file of that name is replaced

 private:
  [[noreturn]] void fail(const char* doing) const;
  struct Close {
    void operator()(std::FILE* f) const noexcept { std::fclose(f); }
  };
  std::string path_, part_;
  std::unique_ptr<std::FILE, Close> file_;
};

void writeAtomically(const std::string& path, std::string_view bytes);

// Makes `directory` and what is missing above it. Throws InputError.
void makeDirectory(const std::string& directory);

}  // namespace pincer::tasks
