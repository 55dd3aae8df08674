#include "pincer/engine/tree/loop_basis.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "pincer/contact/assert.h"
#include "pincer/engine/tree/slot.h"

namespace pincer::engine {
namespace {

double dot(std::span<const double> x, std::span<const double> y, std::size_t from) {
  double sum = 0;
  for (std::size_t i = from; i < x.size(); ++i) sum += x[i] * y[i];
  return sum;
}

}  // namespace

LoopBasis::LoopBasis(const TreeModel& tree) : columns_(tree.before.size()), least_(tree.blocked) {
  for (const TreeLoop& loop : tree.loops) {
    unit_ends_.push_back(count_ + pointRowsOf(loop.kind));
    count_ += rowsOf(loop.kind);
    if (unit_ends_.back() != count_) unit_ends_.push_back(count_);
  }
  rows_.resize(placeOf(count_));
  mirrors_.resize(columns_ * columns_);
  row_scale_.resize(slot(count_));
  order_.resize(slot(count_));
}

void LoopBasis::scaleRows() {
  int first = 0;
  for (const int end : unit_ends_) {
    double most = 0;
    for (int k = first; k < end; ++k) most = std::max(most, dot(row(k), row(k), 0));
    const double scale = most > 0 ? std::sqrt(most) : 1;
    for (int k = first; k < end; ++k) {
      row_scale_[slot(k)] = scale;
      for (double& entry : row(k)) entry /= scale;
    }
    first = end;
  }
}

// Puts the row of which most is left, past its first k entries, in place k.
void LoopBasis::pivot(int k) {
  int best = k;
  double most = -1;
  for (int i = k; i < count_; ++i) {
    const double left = dot(row(i), row(i), slot(k));
    if (left > most) best = i, most = left;
  }
  if (best == k) return;
  std::swap_ranges(row(k).begin(), row(k).end(), row(best).begin());
  std::swap(order_[slot(k)], order_[slot(best)]);
}

void LoopBasis::reflect(int k, std::span<double> x) const {
  const std::span<const double> v = mirror(k);
  const double along = dot(v, x, slot(k));
  for (std::size_t i = slot(k); i < columns_; ++i) x[i] -= along * v[i];
}

void LoopBasis::factorise() {
  scaleRows();
  std::iota(order_.begin(), order_.end(), 0);
  rank_ = reflections_ = 0;
  for (const int most = std::min(count_, static_cast<int>(columns_)); reflections_ < most;) {
    const int k = reflections_;
    pivot(k);
    const std::span<double> own = row(k);
    const double left = std::sqrt(dot(own, own, slot(k)));
    const bool is_new = left > kNothingNew && rank_ == k;
    if (!is_new && (k >= least_ || left == 0)) break;
    const std::span<double> v = std::span(mirrors_).subspan(placeOf(k), columns_);
    std::copy(own.begin(), own.end(), v.begin());
    v[slot(k)] += own[slot(k)] < 0 ? -left : left;
    const double shrink = std::sqrt(2 / dot(v, v, slot(k)));
    for (std::size_t i = slot(k); i < columns_; ++i) v[i] *= shrink;
    for (int i = k; i < count_; ++i) reflect(k, row(i));
    ++reflections_;
    if (is_new) rank_ = reflections_;
  }
}

void LoopBasis::dropBlocked(std::span<double> x) const {
  for (int k = 0; k < reflections_; ++k) reflect(k, x);
  std::fill_n(x.begin(), reflections_, 0.0);
  for (int k = reflections_; k-- > 0;) reflect(k, x);
}

void LoopBasis::takeFree(std::span<double> x) const {
  for (int k = 0; k < reflections_; ++k) reflect(k, x);
  std::shift_left(x.begin(), x.end(), reflections_);
  std::fill(x.end() - reflections_, x.end(), 0.0);
}

void LoopBasis::closing(std::span<const double> want, std::span<double> x) const {
  PINCER_ASSERT(want.size() == slot(count_));
  std::fill(x.begin(), x.end(), 0.0);
  for (int k = 0; k < rank_; ++k) {
    const std::span<const double> own = solvedRow(k);
    double left = want[slot(order_[slot(k)])] / row_scale_[slot(order_[slot(k)])];
    for (int j = 0; j < k; ++j) left -= own[slot(j)] * x[slot(j)];
    x[slot(k)] = left / own[slot(k)];
  }
  for (int k = reflections_; k-- > 0;) reflect(k, x);
}

}  // namespace pincer::engine
