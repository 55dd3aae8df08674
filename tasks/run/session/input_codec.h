// input_codec: the ticks of a person's trial packed without loss, a chunk for each transaction of the writer.
//
// A record is kInputWords words of 64 bits (a number's own bits, in the order of columns.h). Each word is
// XORed with the same word of the tick before (of the chunk's first tick: with 0), and what is left of it is
// written without its zero bytes at either end:
//
//   record   mask of the words that changed, bit i of byte i/8 for word i; then each of those words in order
//   word     one byte: 16 x (zero bytes cut off below) + (bytes that follow, 1 .. 8); then the bytes, the lowest first
//
// So what stands still costs nothing, and numbers of a device that counts in single precision cost half. A chunk needs
// no other. The idea is that of T. Pelkonen et al., "Gorilla: a fast, scalable, in-memory time series database", Proc.
// VLDB Endowment 8(12), 2015; by bytes in place of bits, which is simpler and a little longer.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "pincer/tasks/run/session/columns.h"

namespace pincer::tasks {

// Words of 64 bits in one tick's inputs: a word per column.
constexpr std::size_t kInputWords = [] {
  std::size_t words = 0;
  const InputRecord record{};
  forEachColumn(record, [&](const ColumnName&, const auto&) { ++words; });
  return words;
}();
using InputWords = std::array<std::uint64_t, kInputWords>;

InputWords wordsOf(const InputRecord& record);

// A chunk's check: FNV-1a over trial, first tick, number of ticks and the bytes
// (G. Fowler, L. C. Noll, K.-P. Vo, 64 bits).
std::int64_t checkOf(const InputChunk& chunk);

class InputPacker {
 public:
  // True if `record` goes on where the chunk ends; an empty one takes any.
  bool takes(const InputRecord& record) const;
  void add(const InputRecord& record);
  bool empty() const { return chunk_.ticks == 0; }
  // The chunk, its check made; the packer is empty again.
  InputChunk take();

 private:
  InputChunk chunk_;
  InputWords last_{};
};

// The records of a chunk. Throws InputError, naming trial and ticks, where its bytes aren't those that were written.
std::vector<InputRecord> unpackInputs(const InputChunk& chunk);

}  // namespace pincer::tasks
