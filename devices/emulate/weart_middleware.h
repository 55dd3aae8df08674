// weart_middleware: WEART's Middleware that isn't there: a TCP server that takes forces for thimbles and tells
// its status, parsed by a grammar of its own.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <string>

namespace pincer::devices::emulate {

enum class WeartFault : std::uint8_t {
  kNone,
  kPieces,      // its texts come byte by byte
  kGlued,       // several of them, known and unknown ones, in one
  kOverlong,    // one of 100,000 bytes before each
  kNotRunning,  // it never runs
  kStops,       // it ran, and says that it doesn't any more
  kPassesNothingOn,
  kHangsUp,
};

class WeartMiddleware {
 public:
  explicit WeartMiddleware(std::uint16_t port = 0);  // 0: a free one. Throws std::runtime_error where it is taken
  ~WeartMiddleware();

  std::uint16_t port() const;
  void setFault(WeartFault fault);
  // The level at which a thimble presses, by the names of the protocol ("RIGHT:INDEX"), and
  // when it became that (monotonic clock) [ns].
  double level(const std::string& thimble) const;
  double levelOf(const std::string& thimble) const;  // likewise ("INDEX"), of whichever hand
  std::int64_t since(const std::string& thimble) const;
  std::int64_t commands() const;  // that came: forces and their stops
  std::int64_t unknown() const;   // that it didn't understand
  bool started() const;           // by a client that hasn't stopped it

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace pincer::devices::emulate
