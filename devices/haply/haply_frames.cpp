#include "pincer/devices/haply/haply_frames.h"

namespace pincer::devices::haply {

HaplyMap::HaplyMap(const HaplyFrame& frame) : q_align_(frame.q_align.normalized()), centre_H_(frame.centre_H) {
  const double c = math::cos(frame.mount_turn), s = math::sin(frame.mount_turn);
  Mat3 upright, turned;
  upright << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  turned << c, -s, 0, s, c, 0, 0, 0, 1;
  R_DH_ = upright * turned;
  q_DH_ = Quat(R_DH_);
}

}  // namespace pincer::devices::haply
