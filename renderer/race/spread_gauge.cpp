#include "renderer/race/spread_gauge.h"

#include "renderer/film/saved_values.h"

namespace lacuna {

void SpreadGauge::save(ByteWriter& out) const {
  out.put(count_);
  for (const Image& sum : sums_) put_image(out, sum);
}

void SpreadGauge::load(ByteReader& in) {
  count_ = in.get<std::uint64_t>();
  for (Image& sum : sums_) get_image(in, sum, "sum of spread samples");
}

}  // namespace lacuna
