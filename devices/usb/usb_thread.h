// usb_thread: what a device on USB asks of the thread that moves its frames.
#pragma once
#include <cstdint>

namespace pincer::devices::usb {

class UsbThread {
 public:
  virtual ~UsbThread() = default;
  // There is something to send. From any thread; never waits, allocates nothing.
  virtual void wake() noexcept = 0;
  // The time on the clock by which frames go [ns]. Likewise.
  virtual std::int64_t now() const = 0;
};

}  // namespace pincer::devices::usb
