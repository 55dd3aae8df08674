// json_walk: the values of a JSON text one after the other, each with its path. Nothing is
// told of a text that isn't whole and sound.
//
// Made for text that another program sends: UTF-8 is checked; a number beyond a double's range, an integer beyond 64
// bits, NaN and anything that follows the value are errors. 2 to 3 ns per byte; memory of the heap while it runs, so it
// isn't for the tick. Arrays and objects nest 8 deep at the most, a path is 128 characters long at the most, keys
// joined by '.'; elements of an array have the array's own path: {"a":[{"b":1}]} has the value 1 at "a.b". A dot within
// a key becomes '/', and so does an empty key.
#pragma once
#include <string_view>
#include <variant>

namespace pincer::devices::haply {

using JsonScalar = std::variant<std::monostate, bool, double, std::string_view>;  // monostate: null

// Where the values go. Every function returns false to end the walk.
class JsonSink {
 public:
  virtual ~JsonSink() = default;
  virtual bool value(std::string_view path, const JsonScalar& value) = 0;
  virtual bool begin(std::string_view path, bool array) = 0;
  virtual bool end(std::string_view path, bool array) = 0;
};

// True if `text` was one JSON value and the sink took all of it. Never throws.
bool walkJson(std::string_view text, JsonSink& sink) noexcept;

}  // namespace pincer::devices::haply
