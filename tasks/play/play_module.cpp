// play_module: a PlaySession for a page's JavaScript: numbers in, numbers out. One session at a time.
#include <emscripten.h>

#include <array>
#include <optional>

#include "pincer/tasks/play/play_session.h"

namespace {

using namespace pincer;

constexpr int kMostItems = 8;                       // bodies and fingertips; chosen: both scenes have four
const char* const kScenes[] = {"pickup", "pinch"};  // by playOpen's number
std::optional<tasks::PlaySession> session;
// Of each thing its frame in W: three columns of R, and p [m].
std::array<double, 12 * kMostItems> frames;
// Of each finger: normal and tangential force [N], 1 while it slides. Then the pull [N], flagged ticks.
std::array<double, 8> numbers;

void writeFrame(int item, const Mat3& R, const Vec3& p) {
  double* out = frames.data() + 12 * item;
  for (int k = 0; k < 9; ++k) out[k] = R.data()[k];
  for (int k = 0; k < 3; ++k) out[9 + k] = p[k];
}

}  // namespace

extern "C" {

// 0 pickup, 1 pinch
EMSCRIPTEN_KEEPALIVE void playOpen(int scene) { session.emplace(kScenes[scene]); }

EMSCRIPTEN_KEEPALIVE void playTicks(int ticks, double x, double y, double z, int squeezes, double grip) {
  for (int i = 0; i < ticks; ++i) session->tick({Vec3(x, y, z), squeezes != 0, grip});
}

// Bodies first, then the fingertips.
EMSCRIPTEN_KEEPALIVE double* playFrames() {
  int item = 0;
  for (int i = 0; i < session->bodies(); ++i, ++item) {
    const Pose X_WB = session->bodyPose(i);
    writeFrame(item, X_WB.q.toRotationMatrix(), X_WB.p);
  }
  for (int i = 0; i < session->fingers(); ++i, ++item) writeFrame(item, Mat3::Identity(), session->fingertip(i));
  return frames.data();
}

EMSCRIPTEN_KEEPALIVE double* playNumbers() {
  for (std::size_t i = 0; i < 2; ++i) {
    const grasp::FingerReport& report = session->reports()[i];
    numbers[3 * i] = report.normal_force;
    numbers[3 * i + 1] = report.tangential_force;
    numbers[3 * i + 2] = report.sliding ? 1 : 0;
  }
  numbers[6] = session->pull_W().norm();
  numbers[7] = session->flagged();
  return numbers.data();
}

// Half 0: the lower 32 bits, half 1: the upper ones, of the script that the page repeats when it opens.
EMSCRIPTEN_KEEPALIVE double playHash(int scene, int half) {
  const std::uint64_t hash = tasks::hashOfScript(kScenes[scene], tasks::kScriptTicks);
  return static_cast<double>((hash >> (32 * half)) & 0xffffffffu);
}
}
