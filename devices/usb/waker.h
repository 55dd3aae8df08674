// waker: how a device tells the USB thread that there is something to send.
#pragma once

namespace pincer::devices::usb {

class Waker {
 public:
  virtual ~Waker() = default;
  // From any thread; never waits, allocates nothing.
  virtual void wake() noexcept = 0;
};

}  // namespace pincer::devices::usb
