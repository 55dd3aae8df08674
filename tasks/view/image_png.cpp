#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <cmath>

#include "pincer/contact/error.h"
#include "pincer/contact/io/atomic_file.h"
#include "pincer/tasks/view/image.h"

namespace pincer::tasks {
namespace {

png_image pngHead(const Image& image) {
  png_image head{};
  head.version = PNG_IMAGE_VERSION;
  head.format = PNG_FORMAT_RGB;
  head.width = static_cast<png_uint_32>(image.width);
  head.height = static_cast<png_uint_32>(image.height);
  return head;
}

// Sum of one channel over a block that is cut off at the picture's border, over the block's area.
double blockMean(const Image& image, int x0, int y0, int block, int channel) {
  const int x1 = std::min(x0 + block, image.width), y1 = std::min(y0 + block, image.height);
  double sum = 0;
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) sum += image.bytes[static_cast<std::size_t>(3 * (y * image.width + x) + channel)];
  }
  return sum / ((x1 - x0) * (y1 - y0));
}

}  // namespace

void writePng(const Image& image, const std::string& path) {
  png_image head = pngHead(image);
  std::string bytes(PNG_IMAGE_PNG_SIZE_MAX(head), '\0');
  png_alloc_size_t size = bytes.size();
  if (png_image_write_to_memory(&head, bytes.data(), &size, 0, image.bytes.data(), 0, nullptr) == 0) {
    throw InputError(fmt::format("{}: the picture can't be written as PNG ({}).", path, head.message));
  }
  bytes.resize(size);
  writeAtomically(path, bytes);
}

Image readPng(const std::string& path) {
  png_image head{};
  head.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_file(&head, path.c_str()) == 0) {
    throw InputError(fmt::format("{}: not a readable PNG picture ({}).", path, head.message));
  }
  head.format = PNG_FORMAT_RGB;
  Image image{static_cast<int>(head.width), static_cast<int>(head.height), {}};
  image.bytes.resize(PNG_IMAGE_SIZE(head));
  if (png_image_finish_read(&head, nullptr, image.bytes.data(), 0, nullptr) == 0) {
    throw InputError(fmt::format("{}: a damaged PNG picture ({}).", path, head.message));
  }
  return image;
}

ImageDifference compare(const Image& a, const Image& b, int block) {
  ImageDifference difference;
  if (a.width != b.width || a.height != b.height) return {255, 255};
  int blocks = 0;
  for (int y = 0; y < a.height; y += block) {
    for (int x = 0; x < a.width; x += block) {
      for (int channel = 0; channel < 3; ++channel, ++blocks) {
        const double apart = std::abs(blockMean(a, x, y, block, channel) - blockMean(b, x, y, block, channel));
        difference.mean += apart;
        difference.worst = std::max(difference.worst, apart);
      }
    }
  }
  difference.mean /= std::max(blocks, 1);
  return difference;
}

}  // namespace pincer::tasks
