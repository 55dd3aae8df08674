// input_on_disk: bytes under a name, for readers that take a path; in memory where the system has such a place.
#pragma once
#include <fstream>
#include <string>
#include <string_view>

#include "pincer/tests/support/temporary_directory.h"

namespace pincer::fuzz {

class InputOnDisk {
 public:
  explicit InputOnDisk(const std::string& name) : path_(folder_ / name) {}

  const std::string& path() const { return path_; }
  std::string beside(const std::string& name) const { return folder_ / name; }
  void write(std::string_view bytes) const {
    std::ofstream(path_, std::ios::binary | std::ios::trunc)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }

 private:
  tests::TemporaryDirectory folder_;
  std::string path_;
};

}  // namespace pincer::fuzz
