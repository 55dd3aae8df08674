#include "tasks/scene/json_writer.h"

#include <fmt/format.h>

#include <cmath>

namespace pincer::tasks {

std::string quotedJson(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (static_cast<unsigned char>(c) < 0x20) {
      out += fmt::format("\\u{:04x}", static_cast<int>(c));
    } else {
      out += c;
    }
  }
  return out + '"';
}

JsonWriter& JsonWriter::key(std::string_view name) {
  separate();
  text_ += quotedJson(name) + ": ";
  after_key_ = true;
  return *this;
}

JsonWriter& JsonWriter::value(std::string_view text) {
  separate();
  text_ += quotedJson(text);
  return *this;
}

JsonWriter& JsonWriter::value(double number) {
  separate();
  text_ += std::isfinite(number) ? fmt::format("{}", number) : "null";
  return *this;
}

JsonWriter& JsonWriter::value(std::int64_t number) {
  separate();
  text_ += fmt::format("{}", number);
  return *this;
}

JsonWriter& JsonWriter::value(bool truth) {
  separate();
  text_ += truth ? "true" : "false";
  return *this;
}

JsonWriter& JsonWriter::value(const Vec3& v) { return beginArray().value(v.x()).value(v.y()).value(v.z()).endArray(); }

JsonWriter& JsonWriter::value(const Quat& q) { return beginArray().value(q.w()).value(q.x()).value(q.y()).value(q.z()).endArray(); }

JsonWriter& JsonWriter::open(char bracket) {
  separate();
  text_ += bracket;
  empty_.push_back(true);
  return *this;
}

JsonWriter& JsonWriter::close(char bracket) {
  const bool was_empty = empty_.back();
  empty_.pop_back();
  if (!was_empty) breakLine();
  text_ += bracket;
  if (empty_.empty()) text_ += '\n';
  return *this;
}

void JsonWriter::separate() {
  if (after_key_) {
    after_key_ = false;
    return;
  }
  if (empty_.empty()) return;
  if (!empty_.back()) text_ += ',';
  empty_.back() = false;
  breakLine();
}

void JsonWriter::breakLine() {
  text_ += '\n';
  text_.append(2 * empty_.size(), ' ');
}

}  // namespace pincer::tasks
