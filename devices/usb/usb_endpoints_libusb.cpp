#include <libusb.h>

#include "pincer/devices/usb/frame.h"
#include "pincer/devices/usb/usb_endpoints.h"

namespace pincer::devices::usb {
namespace {

// libusb 1.0.26 may leave an endpoint that the descriptor counts empty: address 0.
bool isPacketEndpoint(const libusb_endpoint_descriptor& e) {
  const int type = e.bmAttributes & LIBUSB_TRANSFER_TYPE_MASK;
  return e.bEndpointAddress != 0 && (type == LIBUSB_TRANSFER_TYPE_INTERRUPT || type == LIBUSB_TRANSFER_TYPE_BULK) &&
         (e.wMaxPacketSize & 0x7ff) >= static_cast<int>(kFrameSize);
}

}  // namespace

Endpoints endpointsOf(libusb_device* device) {
  Endpoints found;
  libusb_config_descriptor* config = nullptr;
  if (libusb_get_active_config_descriptor(device, &config) != 0) return found;
  if (config->bNumInterfaces > 0 && config->interface[0].num_altsetting > 0) {
    const libusb_interface_descriptor& face = config->interface[0].altsetting[0];
    for (int i = 0; i < face.bNumEndpoints && face.endpoint != nullptr; ++i) {
      const libusb_endpoint_descriptor& e = face.endpoint[i];
      if (!isPacketEndpoint(e)) continue;
      const bool in = (e.bEndpointAddress & LIBUSB_ENDPOINT_IN) != 0;
      std::uint8_t& address = in ? found.in : found.out;
      if (address != 0) continue;
      address = e.bEndpointAddress;
      (in ? found.in_type : found.out_type) = e.bmAttributes & LIBUSB_TRANSFER_TYPE_MASK;
    }
  }
  libusb_free_config_descriptor(config);
  return found;
}

}  // namespace pincer::devices::usb
