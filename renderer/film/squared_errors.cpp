#include "renderer/film/squared_errors.h"

#include <algorithm>
#include <functional>

#include "renderer/film/saved_values.h"

namespace lacuna {

void SquaredErrors::add(double value) {
  ++count_;
  if (heap_.size() == kept) {
    if (value <= heap_.front()) return;
    std::pop_heap(heap_.begin(), heap_.end(), std::greater<>());
    heap_.back() = value;
  } else {
    heap_.push_back(value);
  }
  std::push_heap(heap_.begin(), heap_.end(), std::greater<>());
}

void SquaredErrors::add(const Sums& sums, int width, int height) {
  const auto share = [](int size, int first) { return (size - first + side - 1) / side; };
  for (int y = 0; y < std::min(side, height); ++y) {
    for (int x = 0; x < std::min(side, width); ++x) {
      const double pixels = double(share(width, x)) * share(height, y);
      add(sums[std::size_t(y * side + x)] / pixels);
    }
  }
}

void SquaredErrors::merge(const SquaredErrors& other) {
  for (const double value : other.heap_) add(value);
  count_ += other.count_ - other.heap_.size();  // those too small for the heap
}

std::vector<double> SquaredErrors::largest() const {
  std::vector<double> values = heap_;
  std::sort(values.begin(), values.end());
  return values;
}

void SquaredErrors::save(ByteWriter& out) const {
  out.put(count_);
  out.put(heap_);
}

void SquaredErrors::load(ByteReader& in) {
  count_ = in.get<std::uint64_t>();
  heap_ = get_finite(in, std::size_t(std::min<std::uint64_t>(count_, kept)), "squared errors");
  if (!std::is_heap(heap_.begin(), heap_.end(), std::greater<>())) {
    throw std::runtime_error("saved squared errors have another order");
  }
}

}  // namespace lacuna
