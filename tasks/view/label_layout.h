// label_layout: places for labels so that none lies over another, nor over the things that they tell of.
#pragma once
#include <vector>

#include "pincer/contact/math.h"

namespace pincer::tasks {

struct LabelBox {
  Vec2 anchor = Vec2::Zero();  // that it belongs to [pixels, y down]
  Vec2 size = Vec2::Zero();    // with its border [pixels]
};

// The middle of each label [pixels]: over its anchor, or at the nearest of the tried places around it where it lies
// inside a picture of this size, over none that came before and over no thing; beside the others only where things
// leave no room; over its anchor if there is none at all. The order of the labels decides, so a picture of the same
// labels is the same.
std::vector<Vec2> layOut(const std::vector<LabelBox>& labels, const std::vector<Eigen::AlignedBox2d>& things,
                         const Vec2& picture);

}  // namespace pincer::tasks
