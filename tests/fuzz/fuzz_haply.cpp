#include <cmath>
#include <optional>
#include <string_view>

#include "pincer/devices/haply/haply_messages.h"
#include "pincer/tests/fuzz/demand.h"
#include "pincer/tests/fuzz/targets.h"

namespace pincer::fuzz {
namespace {

using namespace devices::haply;

void demandWithin(const std::optional<Vec3>& v, double most, std::string_view promise) {
  if (v) demand(v->allFinite() && v->cwiseAbs().maxCoeff() <= most, promise);
}

void demandSound(const DeviceReport& device) {
  demand(!device.id.view().empty(), "a device has an id");
  demandWithin(device.p_H, kFarthest, "places are in reach");
  demandWithin(device.v_H, kFastest, "speeds are in range");
  demandWithin(device.f_H, kStrongest, "forces are in range");
  if (device.q_H) demand(std::abs(device.q_H->norm() - 1) < 2 * kOffUnit, "quaternions are of unit length");
}

}  // namespace

void haply_message(Bytes input) {
  const std::string_view text = textOf(input);
  ServiceMessage message;
  const ReadError error = readService(text, message);
  demand(describe(error) != nullptr, "every error has a phrase");
  if (error == ReadError::kNone) {
    demand(message.count <= kMostDevices, "no more devices than there is room for");
    for (std::size_t i = 0; i < message.count; ++i) demandSound(message.devices[i]);
  }
  ServiceEvent event;
  if (readEvent(text, event) == ReadError::kNone) demand(!event.name.view().empty(), "an event has a name");
  readVersion(text);
  readNumber(text);
  demand(readDeviceIds(text).count <= kMostDevices, "no more ids than there is room for");
}

}  // namespace pincer::fuzz
