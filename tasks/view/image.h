// image: a picture of 8-bit RGB, rows from the top.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace pincer::tasks {

struct Image {
  int width = 0, height = 0;        // [pixels]
  std::vector<std::uint8_t> bytes;  // red, green, blue of a pixel, then of the next to the right

  bool operator==(const Image&) const = default;
};

// Both throw InputError when the file can't be written or isn't a PNG.
void writePng(const Image& image, const std::string& path);
Image readPng(const std::string& path);

// How much two pictures of the same size differ, in a way that doesn't mind how a driver draws the border of a thing:
// both are averaged over blocks of `block` x `block` pixels first.
struct ImageDifference {
  double mean = 0;   // of a block's channel, 0 .. 255
  double worst = 0;  // likewise
};
ImageDifference compare(const Image& a, const Image& b, int block);

}  // namespace pincer::tasks
