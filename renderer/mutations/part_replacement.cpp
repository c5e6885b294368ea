#include "renderer/mutations/part_replacement.h"

#include <cmath>

namespace lacuna {
namespace {

/// The largest change of the number of vertices.
constexpr int most_change = 2;

/// Weight of deleting `n` vertices: short parts are accepted more often.
double deletion_weight(int n) { return n == 0 ? 0.25 : std::ldexp(1.0, -n); }
/// Sum of the weights for a path of `edges`.
double deletion_sum(int edges) { return 1.25 - std::ldexp(1.0, -edges); }

/// Number of positions of `n` vertices in a path x_1 ... x_edges. None are inserted after the
/// emitter.
int places(int edges, int n) { return n == 0 ? edges : edges - n + 1; }

}  // namespace

double PartReplacement::weight(int edges, int deleted, int added, bool to_end) const {
  const int result = edges - deleted + added;
  const int change = std::abs(added - deleted);
  const bool allowed = added >= (to_end || deleted == 0 ? 1 : 0) && change <= most_change &&
                       result >= paths_.least_edges && result <= paths_.lengths.max_depth;
  if (!allowed) return 0;
  return change == 0 ? 1 : change == 1 ? 0.3 : 0.1;
}

double PartReplacement::weight_sum(int edges, int deleted, bool to_end) const {
  double sum = 0;
  for (int n = deleted - most_change; n <= deleted + most_change; ++n) {
    sum += weight(edges, deleted, n, to_end);
  }
  return sum;
}

double PartReplacement::probability(int edges, int deleted, int added, bool to_end) const {
  const double sum = weight_sum(edges, deleted, to_end);
  if (!(sum > 0)) return 0;
  return deletion_weight(deleted) / deletion_sum(edges) / places(edges, deleted) *
         weight(edges, deleted, added, to_end) / sum;
}

bool PartReplacement::propose(const WholePath& path, PathBuilder& builder, Rng& rng) {
  const int k = path.edge_count();
  double u = rng.next_choice() * deletion_sum(k);
  deleted_ = 0;
  while (deleted_ < k && u >= deletion_weight(deleted_)) u -= deletion_weight(deleted_++);
  first_ = static_cast<int>(rng.below(static_cast<std::uint64_t>(places(k, deleted_))));
  const int last = first_ + deleted_ + 1;
  to_end_ = last == k + 1;
  const double sum = weight_sum(k, deleted_, to_end_);
  if (!(sum > 0)) return false;
  u = rng.next_choice() * sum;
  added_ = deleted_ - most_change;
  while (added_ < deleted_ + most_change && u >= weight(k, deleted_, added_, to_end_)) {
    u -= weight(k, deleted_, added_++, to_end_);
  }
  if (weight(k, deleted_, added_, to_end_) == 0) return false;  // possible by rounding of the sum
  const int eye = static_cast<int>(rng.below(static_cast<std::uint64_t>(added_) + 1));
  const int light = added_ - eye;
  builder.keep(path, first_, last);
  if (!builder.sample_from_eye(eye, rng) || !builder.sample_from_light(light, rng)) return false;
  return !builder.light().empty() || builder.end_on_emitter();
}

long double PartReplacement::reverse_ratio(const PathMeasure& measure, const VertexPool& pool,
                                           const WholePath& from, const WholePath& to) const {
  const double back = probability(to.edge_count(), added_, deleted_, to_end_) / (deleted_ + 1);
  const double forth = probability(from.edge_count(), deleted_, added_, to_end_) / (added_ + 1);
  return back * measure.between(from, pool, first_, first_ + deleted_ + 1) /
         (forth * measure.between(to, pool, first_, first_ + added_ + 1));
}

}  // namespace lacuna
