// port_name: where a device is plugged in, as Linux writes it: bus-port, and the ports of the hubs
// between, "1-2.3". For the *_libusb.cpp alone.
#pragma once
#include <string>

struct libusb_device;

namespace pincer::devices::usb {

std::string portName(libusb_device* device);

}  // namespace pincer::devices::usb
