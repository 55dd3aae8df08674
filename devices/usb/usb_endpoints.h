// The two endpoints of a device that carry its frames.
#pragma once
#include <cstdint>

struct libusb_device;

namespace pincer::devices::usb {

// The first endpoint of each direction that is interrupt or bulk and holds a whole frame.
//   in, out            addresses; 0: the device has none
//   in_type, out_type  LIBUSB_TRANSFER_TYPE_INTERRUPT or _BULK; meaningless where the address is 0
struct Endpoints {
  std::uint8_t in = 0, out = 0;
  std::uint8_t in_type = 0, out_type = 0;
};

// The endpoints of the device's first interface. Both addresses are 0 where its descriptors can't be read.
Endpoints endpointsOf(libusb_device* device);

}  // namespace pincer::devices::usb
