// remote_port: an emulated device as the emulator's process sees it: plugged in, opened by a
// program through usbfs_preload, and unplugged.
#pragma once
#include <array>
#include <map>
#include <memory>
#include <string>

#include "pincer/tests/emulation/usbfs_device.h"
#include "pincer/tests/emulation/usbfs_wire.h"

namespace pincer::emulation {

class RemotePort {
 public:
  explicit RemotePort(std::shared_ptr<UsbGadget> gadget) : gadget_(std::move(gadget)) {}
  ~RemotePort() { hangUp(); }
  RemotePort(const RemotePort&) = delete;
  RemotePort& operator=(const RemotePort&) = delete;

  void plug();
  void unplug();
  std::string descriptors() const { return gadget_->descriptors(); }
  bool plugged() const { return device_ != nullptr; }
  // Whoever has opened the device; a descriptor to poll, or -1.
  int connection() const { return connection_; }
  // A program asks for it over `connection`, which is its own from now on.
  void opened(int connection);
  // Something has come on the connection.
  void serve();
  // To the present, and what came of it to the program.
  void catchUp();

 private:
  struct Transfer {
    std::array<std::uint8_t, kMostTransferBytes> data{};
    std::unique_ptr<usbdevfs_urb> urb = std::make_unique<usbdevfs_urb>();
  };
  void take(const UsbfsRequest& request);
  void complete(std::uint64_t key, const usbdevfs_urb& urb);
  void flush();
  void hangUp();

  std::shared_ptr<UsbGadget> gadget_;
  std::unique_ptr<UsbfsDevice> device_;
  std::map<std::uint64_t, std::unique_ptr<Transfer>> transfers_;
  int connection_ = -1, pipe_ = -1;  // pipe_: the read end of what the program polls
};

}  // namespace pincer::emulation
