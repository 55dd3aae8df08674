// json_writer: JSON for machines (`--json`), written in order, numbers with the fewest digits that read back to
// the same bits, NaN and infinity as null.
//
//   JsonWriter json;
//   json.beginObject().key("name").value("s4").key("tick_us").value(0.9).endObject();
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pincer/contact/math.h"

namespace pincer::tasks {

std::string quotedJson(std::string_view text);  // in quotes, escaped; bytes that are no UTF-8 become U+FFFD

class JsonWriter {
 public:
  JsonWriter& beginObject() { return open('{'); }
  JsonWriter& endObject() { return close('}'); }
  JsonWriter& beginArray() { return open('['); }
  JsonWriter& endArray() { return close(']'); }
  JsonWriter& key(std::string_view name);
  JsonWriter& value(std::string_view text);
  JsonWriter& value(const char* text) { return value(std::string_view(text)); }
  JsonWriter& value(double number);
  JsonWriter& value(std::int64_t number);
  JsonWriter& value(std::uint64_t number);
  JsonWriter& value(int number) { return value(static_cast<std::int64_t>(number)); }
  JsonWriter& value(bool truth);
  JsonWriter& row(std::span<const double> numbers);  // an array on one line
  JsonWriter& value(const Vec3& v);                  // [x, y, z]
  JsonWriter& value(const Quat& q);                  // [w, x, y, z]

  const std::string& text() const { return text_; }

 private:
  JsonWriter& open(char bracket);
  JsonWriter& close(char bracket);
  void separate();  // comma and line break before a member, where one is due
  void breakLine();

  std::string text_;
  std::vector<bool> empty_;  // per open bracket: nothing in it yet
  bool after_key_ = false;
};

}  // namespace pincer::tasks
