// Messages of Haply's service with bytes changed, put in and taken out; nlohmann's tree says what is JSON.
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>
#include <string>

#include "pincer/devices/emulate/changed_json.h"
#include "pincer/devices/emulate/haply_service.h"
#include "pincer/devices/haply/haply_messages.h"
#include "pincer/tasks/judge/bench/devices/haply_parts.h"

namespace pincer::tasks {
namespace {

using devices::haply::DeviceReport;
using devices::haply::ServiceMessage;

constexpr std::int64_t kUsual = 20'000, kThorough = 10'000'000;  // texts, the second with --long; chosen
constexpr std::size_t kMostChanges = 7;                          // of a text at most; chosen

bool isSound(const DeviceReport& device) {
  const auto within = [](const std::optional<Vec3>& v, double most) {
    return !v || (v->allFinite() && v->cwiseAbs().maxCoeff() <= most);
  };
  const bool turn = !device.q_H || std::abs(device.q_H->norm() - 1) < 1e-9;
  return within(device.p_H, 2) && within(device.v_H, 20) && turn;
}

}  // namespace

std::vector<Record> haplyTexts(MeasureContext& context) {
  devices::emulate::HaplyService service;
  std::array<std::string, 2> seeds;
  const int session = service.connected(seeds[0]);
  seeds[1] = service.answer(session, R"({"inverse3":[]})").front();
  std::mt19937_64 random(31);
  ServiceMessage message;
  const std::int64_t wanted = context.thorough ? kThorough : kUsual;
  std::int64_t taken = 0, unsound = 0, no_json = 0, done = 0;
  for (; done < wanted && !(done % 1024 == 0 && context.interrupted()); ++done) {
    if (done % 1024 == 0) context.progress(static_cast<double>(done) / static_cast<double>(wanted));
    const std::string text =
        devices::emulate::changedJson(seeds[static_cast<std::size_t>(done % 2)], kMostChanges, random);
    if (readService(text, message) != devices::haply::ReadError::kNone) {
      unsound += message.count != 0 ? 1 : 0;  // refused, and yet it tells something
      continue;
    }
    ++taken;
    no_json += nlohmann::json::accept(text) ? 0 : 1;
    for (std::size_t i = 0; i < message.count; ++i) unsound += isSound(message.devices[i]) ? 0 : 1;
  }
  return {unbounded("mutated messages", static_cast<double>(done), "-"),
          unbounded("of them sound", static_cast<double>(taken), "-"),
          exactly("taken though no JSON", static_cast<double>(no_json), "-", 0),
          exactly("taken though not finite or out of range", static_cast<double>(unsound), "-", 0)};
}

}  // namespace pincer::tasks
