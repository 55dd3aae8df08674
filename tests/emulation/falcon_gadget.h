// falcon_gadget: the emulated Falcon on an emulated cable. Its chip answers once per frame of
// the bus, a millisecond, as full speed does.
#pragma once
#include "pincer/tests/emulation/usb_gadget.h"
#include "pincer/tests/support/emulated_falcon.h"

namespace pincer::emulation {

class FalconGadget final : public UsbGadget {
 public:
  FalconGadget(std::string serial, std::size_t image_size) : falcon(image_size), serial_(std::move(serial)) {}

  // 0403:cb48, bulk endpoints 0x81 and 0x02 of 64 bytes, serial number in string 3.
  std::string descriptors() const override {
    return "12010002000000400304"
           "48cb"
           "0002"
           "00000301"
           "0902200001010080"
           "2d"
           "0904000002ffffff00"
           "07058102400000"
           "07050202400000";
  }
  unsigned outEndpoint() const override { return 0x02; }
  std::string serialText() const override { return serial_; }
  void powerUp() override {}
  void received(std::span<const std::uint8_t> packet) override { falcon.write(packet); }
  void advance(double dt) override {
    falcon.advance(dt);
    frames_ = 2;
  }
  std::size_t take(Packet& packet) override {
    if (frames_ == 0) return 0;
    --frames_;
    return falcon.read(packet);
  }
  bool control(std::uint8_t request, std::uint16_t value) override { return falcon.control(request, value); }

  tests::EmulatedFalcon falcon;

 private:
  std::string serial_;
  int frames_ = 0;  // packets that may still go in this millisecond
};

}  // namespace pincer::emulation
