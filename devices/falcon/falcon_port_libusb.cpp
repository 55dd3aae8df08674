#include <libusb.h>

#include <stdexcept>
#include <string>

#include "devices/falcon/falcon_arm.h"

namespace pincer::devices::falcon {
namespace {

constexpr std::uint16_t kFtdiVendor = 0x0403, kFalconProduct = 0xcb48;
constexpr std::uint8_t kFalconOut = 0x02, kFalconIn = 0x81;
constexpr unsigned kPortTimeout = 1000;  // [ms]

class LibusbFalconPort final : public FalconPort {
 public:
  LibusbFalconPort() {
    if (libusb_init(&context_) != 0) throw std::runtime_error("USB: libusb can't start.");
    try {
      open();
    } catch (...) {
      shut();
      throw;
    }
  }
  ~LibusbFalconPort() override { shut(); }
  LibusbFalconPort(const LibusbFalconPort&) = delete;
  LibusbFalconPort& operator=(const LibusbFalconPort&) = delete;

  bool control(std::uint8_t request, std::uint16_t value) override {
    return libusb_control_transfer(handle_, LIBUSB_REQUEST_TYPE_VENDOR, request, value, 0, nullptr, 0, kPortTimeout) == 0;
  }
  bool write(std::span<const std::uint8_t> bytes) override {
    int sent = 0;
    auto* data = const_cast<std::uint8_t*>(bytes.data());  // libusb only reads it
    return libusb_bulk_transfer(handle_, kFalconOut, data, static_cast<int>(bytes.size()), &sent, kPortTimeout) == 0 &&
           sent == static_cast<int>(bytes.size());
  }
  int read(std::span<std::uint8_t> bytes, int timeout_ms) override {
    int got = 0;
    const int error =
        libusb_bulk_transfer(handle_, kFalconIn, bytes.data(), static_cast<int>(bytes.size()), &got, static_cast<unsigned>(timeout_ms));
    return error == 0 || error == LIBUSB_ERROR_TIMEOUT ? got : -1;
  }

 private:
  void open() {
    libusb_device** list = nullptr;
    const auto count = libusb_get_device_list(context_, &list);
    int error = LIBUSB_ERROR_NO_DEVICE;
    for (std::ptrdiff_t i = 0; i < count && handle_ == nullptr; ++i) {
      libusb_device_descriptor d;
      if (libusb_get_device_descriptor(list[i], &d) == 0 && d.idVendor == kFtdiVendor && d.idProduct == kFalconProduct)
        error = libusb_open(list[i], &handle_);
    }
    if (count >= 0) libusb_free_device_list(list, 1);
    if (error == LIBUSB_ERROR_NO_DEVICE)
      throw std::runtime_error("No Novint Falcon is plugged in. Check its USB cable and its power supply.");
    if (error == LIBUSB_ERROR_ACCESS) {
      throw std::runtime_error(
          "No permission to open the Falcon. Install the udev rule and join its group (docs/devices.md), then replug it.");
    }
    if (error == 0) {
      libusb_set_auto_detach_kernel_driver(handle_, 1);  // ftdi_sio takes it for a serial port
      error = libusb_claim_interface(handle_, 0);
    }
    if (error != 0) throw std::runtime_error(std::string("The Falcon can't be opened (") + libusb_error_name(error) + "). Replug it.");
  }
  void shut() {
    if (handle_ != nullptr) libusb_release_interface(handle_, 0), libusb_close(handle_);
    libusb_exit(context_);
  }

  libusb_context* context_ = nullptr;
  libusb_device_handle* handle_ = nullptr;
};

}  // namespace

std::unique_ptr<FalconPort> openFalconPort() { return std::make_unique<LibusbFalconPort>(); }

}  // namespace pincer::devices::falcon
