#include "pincer/tasks/run/session/input_codec.h"

#include <fmt/format.h>

#include <bit>
#include <utility>

#include "pincer/contact/error.h"
#include "pincer/contact/functions/invariants.h"

namespace pincer::tasks {
namespace {

constexpr std::size_t kMaskBytes = (kInputWords + 7) / 8;  // a bit per word: it changed

void packWord(std::uint64_t word, std::string& bytes) {
  PINCER_ASSERT(word != 0);  // only what changed is written
  const int below = std::countr_zero(word) / 8;
  const int above = std::countl_zero(word) / 8;
  const int kept = 8 - below - above;
  bytes += static_cast<char>(16 * below + kept);
  word >>= 8 * below;
  for (int i = 0; i < kept; ++i) bytes += static_cast<char>(word >> (8 * i));
}

// Reads what InputPacker wrote; never beyond the end, whatever the bytes.
class ByteReader {
 public:
  explicit ByteReader(const std::string& bytes) : bytes_(bytes) {}
  std::uint64_t byte() {
    ok_ = ok_ && at_ < bytes_.size();
    return ok_ ? static_cast<unsigned char>(bytes_[at_++]) : 0;
  }
  std::uint64_t word() {
    const std::uint64_t head = byte(), below = head / 16, kept = head % 16;
    ok_ = ok_ && kept >= 1 && below + kept <= 8;
    std::uint64_t word = 0;
    for (std::uint64_t i = 0; ok_ && i < kept; ++i) word |= byte() << (8 * (below + i));
    return word;
  }
  bool ok() const { return ok_; }
  bool atEnd() const { return at_ == bytes_.size(); }

 private:
  const std::string& bytes_;
  std::size_t at_ = 0;
  bool ok_ = true;
};

InputRecord recordOf(const InputWords& words) {
  InputRecord record;
  std::size_t i = 0;
  forEachColumn(record, [&]<class Field>(const ColumnName&, Field& field) {
    if constexpr (std::is_floating_point_v<Field>) {
      field = std::bit_cast<double>(words[i++]);
    } else {
      field = static_cast<Field>(words[i++]);
    }
  });
  return record;
}

[[noreturn]] void refuse(const InputChunk& chunk) {
  throw InputError(
      fmt::format("the inputs of trial {}, ticks {} to {}, are damaged: their bytes aren't those that were recorded. "
                  "Take a copy of the "
                  "session from before.",
                  chunk.trial + 1, chunk.first_tick, chunk.first_tick + chunk.ticks - 1));
}

}  // namespace

std::int64_t checkOf(const InputChunk& chunk) {
  std::uint64_t hash = 0xcbf29ce484222325;
  const auto mix = [&](std::uint64_t byte) { hash = (hash ^ byte) * 0x100000001b3; };
  for (const std::int64_t value : {chunk.trial, chunk.first_tick, chunk.ticks}) {
    for (int i = 0; i < 8; ++i) mix(static_cast<std::uint64_t>(value) >> (8 * i) & 0xff);
  }
  for (const char c : chunk.data.value) mix(static_cast<unsigned char>(c));
  return static_cast<std::int64_t>(hash);
}

InputWords wordsOf(const InputRecord& record) {
  InputWords words{};
  std::size_t i = 0;
  forEachColumn(record, [&]<class Field>(const ColumnName&, const Field& field) {
    if constexpr (std::is_floating_point_v<Field>) {
      words[i++] = std::bit_cast<std::uint64_t>(field);
    } else {
      words[i++] = static_cast<std::uint64_t>(field);
    }
  });
  return words;
}

bool InputPacker::takes(const InputRecord& record) const {
  return empty() || (record.trial == chunk_.trial && record.tick == chunk_.first_tick + chunk_.ticks);
}

void InputPacker::add(const InputRecord& record) {
  PINCER_ASSERT(takes(record));
  if (empty()) {
    chunk_.trial = record.trial;
    chunk_.first_tick = record.tick;
    last_ = {};
  }
  const InputWords words = wordsOf(record);
  std::array<char, kMaskBytes> mask{};
  for (std::size_t i = 0; i < kInputWords; ++i) {
    if (words[i] != last_[i]) mask[i / 8] = static_cast<char>(mask[i / 8] | 1 << i % 8);
  }
  chunk_.data.value.append(mask.data(), mask.size());
  for (std::size_t i = 0; i < kInputWords; ++i) {
    if (words[i] != last_[i]) packWord(words[i] ^ last_[i], chunk_.data.value);
  }
  last_ = words;
  ++chunk_.ticks;
}

InputChunk InputPacker::take() {
  PINCER_ASSERT(!empty());
  chunk_.check = checkOf(chunk_);
  return std::exchange(chunk_, {});
}

std::vector<InputRecord> unpackInputs(const InputChunk& chunk) {
  if (chunk.check != checkOf(chunk)) refuse(chunk);
  std::vector<InputRecord> records;
  InputWords words{};
  ByteReader reader(chunk.data.value);
  for (std::int64_t k = 0; k < chunk.ticks; ++k) {
    std::array<std::uint64_t, kMaskBytes> mask{};
    for (std::uint64_t& byte : mask) byte = reader.byte();
    for (std::size_t i = 0; i < kInputWords; ++i) {
      if (mask[i / 8] >> i % 8 & 1) words[i] ^= reader.word();
    }
    if (!reader.ok()) refuse(chunk);
    records.push_back(recordOf(words));
  }
  if (!reader.atEnd()) refuse(chunk);
  return records;
}

}  // namespace pincer::tasks
