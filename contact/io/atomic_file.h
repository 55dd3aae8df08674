// atomic_file: a text or binary file that appears whole or not at all: written beside its place
// (part_file.h), flushed to the disk, renamed.
//
// Errors: InputError with path, cause and remedy; the partial file is removed, as it is when an exception passes by.
#pragma once
#include <string>
#include <string_view>

#include "pincer/contact/io/part_file.h"

namespace pincer {

class AtomicFile {
 public:
  explicit AtomicFile(std::string path) : path_(std::move(path)), part_(path_) {}
  void write(std::string_view bytes);
  void commit();  // an older file of that name is replaced

 private:
  void flush();
  std::string path_;
  PartFile part_;
  std::string pending_;
};

void writeAtomically(const std::string& path, std::string_view bytes);

// Makes `directory` and what is missing above it. Throws InputError.
void makeDirectory(const std::string& directory);

}  // namespace pincer
