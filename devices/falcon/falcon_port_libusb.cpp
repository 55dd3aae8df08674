#include <libusb.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

#include "pincer/devices/falcon/falcon_arm.h"
#include "pincer/devices/usb/port_name.h"

namespace pincer::devices::falcon {
namespace {

// USB numbers and endpoints of the FTDI chip in a Falcon.
constexpr std::uint16_t kFtdiVendor = 0x0403, kFalconProduct = 0xcb48;
constexpr std::uint8_t kFalconOut = 0x02, kFalconIn = 0x81;
constexpr unsigned kPortTimeout = 1000;  // [ms]

class LibusbContext {
 public:
  LibusbContext() {
    if (libusb_init(&context_) != 0) throw std::runtime_error("USB: libusb can't start.");
  }
  ~LibusbContext() { libusb_exit(context_); }
  LibusbContext(const LibusbContext&) = delete;
  LibusbContext& operator=(const LibusbContext&) = delete;

  // Every Falcon, in the order of the ports.
  std::vector<libusb_device*> falcons() {
    std::vector<libusb_device*> found;
    libusb_device** list = nullptr;
    const auto count = libusb_get_device_list(context_, &list);
    for (std::ptrdiff_t i = 0; i < count; ++i) {
      libusb_device_descriptor d;
      const bool is_one =
          libusb_get_device_descriptor(list[i], &d) == 0 && d.idVendor == kFtdiVendor && d.idProduct == kFalconProduct;
      is_one ? found.push_back(list[i]) : libusb_unref_device(list[i]);
    }
    if (count >= 0) libusb_free_device_list(list, 0);
    std::sort(found.begin(), found.end(),
              [](libusb_device* a, libusb_device* b) { return usb::portName(a) < usb::portName(b); });
    return found;
  }

 private:
  libusb_context* context_ = nullptr;
};

std::string serialOf(libusb_device_handle* handle) {
  libusb_device_descriptor d;
  std::array<unsigned char, 64> text{};
  if (libusb_get_device_descriptor(libusb_get_device(handle), &d) != 0 || d.iSerialNumber == 0) return "";
  const int length =
      libusb_get_string_descriptor_ascii(handle, d.iSerialNumber, text.data(), static_cast<int>(text.size()));
  return length > 0 ? std::string(text.begin(), text.begin() + length) : "";
}

std::string serialOf(libusb_device* device) {
  libusb_device_handle* handle = nullptr;
  if (libusb_open(device, &handle) != 0) return "";
  const std::string serial = serialOf(handle);
  libusb_close(handle);
  return serial;
}

[[noreturn]] void refuseFalcon(const std::string& port, int error) {
  if (error == LIBUSB_ERROR_ACCESS) {
    throw std::runtime_error("No permission to open the Falcon at USB port " + port +
                             ". Install the udev rule and join its group (docs/devices/setup.md), then replug it.");
  }
  if (error == LIBUSB_ERROR_BUSY)
    throw std::runtime_error("Another program uses the Falcon at USB port " + port + ". Close that program.");
  throw std::runtime_error("The Falcon at USB port " + port + " can't be opened (" + libusb_error_name(error) +
                           "). Replug it.");
}

class LibusbFalconPort final : public FalconPort {
 public:
  explicit LibusbFalconPort(const std::string& port) : port_(port) {
    int error = LIBUSB_ERROR_NO_DEVICE;
    for (libusb_device* device : context_.falcons()) {
      if (usb::portName(device) == port) error = libusb_open(device, &handle_);
      libusb_unref_device(device);
    }
    if (error != 0) refuseFalcon(port, error);
    libusb_set_auto_detach_kernel_driver(handle_, 1);  // ftdi_sio takes it for a serial port
    error = libusb_claim_interface(handle_, 0);
    if (error == 0) return;
    libusb_close(handle_);
    refuseFalcon(port, error);
  }
  ~LibusbFalconPort() override {
    libusb_release_interface(handle_, 0);
    libusb_close(handle_);
  }
  LibusbFalconPort(const LibusbFalconPort&) = delete;
  LibusbFalconPort& operator=(const LibusbFalconPort&) = delete;

  std::string place() const override { return port_; }
  bool control(std::uint8_t request, std::uint16_t value) override {
    return libusb_control_transfer(handle_, LIBUSB_REQUEST_TYPE_VENDOR, request, value, 0, nullptr, 0, kPortTimeout) ==
           0;
  }
  bool write(std::span<const std::uint8_t> bytes) override {
    int sent = 0;
    auto* data = const_cast<std::uint8_t*>(bytes.data());  // libusb only reads it
    return libusb_bulk_transfer(handle_, kFalconOut, data, static_cast<int>(bytes.size()), &sent, kPortTimeout) == 0 &&
           sent == static_cast<int>(bytes.size());
  }
  int read(std::span<std::uint8_t> bytes, int timeout_ms) override {
    int got = 0;
    const int error = libusb_bulk_transfer(handle_, kFalconIn, bytes.data(), static_cast<int>(bytes.size()), &got,
                                           static_cast<unsigned>(timeout_ms));
    return error == 0 || error == LIBUSB_ERROR_TIMEOUT ? got : -1;
  }

 private:
  LibusbContext context_;
  libusb_device_handle* handle_ = nullptr;
  std::string port_;
};

}  // namespace

std::vector<FalconPlace> listFalcons() {
  LibusbContext context;
  std::vector<FalconPlace> places;
  for (libusb_device* device : context.falcons()) {
    places.push_back({usb::portName(device), serialOf(device)});
    libusb_unref_device(device);
  }
  return places;
}

std::unique_ptr<FalconPort> openFalconPort(const std::string& port) { return std::make_unique<LibusbFalconPort>(port); }

}  // namespace pincer::devices::falcon
