#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lacuna {

/// Alg. 7 of Noel 2015 in both directions of a line: each position takes the largest ball whose
/// radius exceeds its distance, and keeps its own unless that is larger.
class LineDilation {
 public:
  /// For lines of up to `length` positions.
  explicit LineDilation(int length) : queue_(static_cast<std::size_t>(length) + 1) {}

  /// `radius` and `centre` of each of `n` positions; radius 0 is outside the domain.
  void operator()(std::uint16_t* radius, std::uint32_t* centre, int n) {
    scan<1>(radius, centre, n);
    scan<-1>(radius + (n - 1), centre + (n - 1), n);
  }

 private:
  struct Ball {
    int end;  // the first position that it does not reach
    std::uint16_t radius;
    std::uint32_t centre;
  };

  template <int step>
  void scan(std::uint16_t* radius, std::uint32_t* centre, int n) {
    // The balls that a later position may take, by descending radius and so by ascending end.
    std::size_t front = 0, back = 0;
    for (int i = 0; i < n; ++i, radius += step, centre += step) {
      const std::uint16_t r = *radius;
      if (front < back && queue_[front].end == i) ++front;
      if (front == back || r >= queue_[front].radius || r == 0) {
        front = 0;
        back = 0;
        if (r > 0) queue_[back++] = {i + r, r, *centre};
        continue;
      }
      while (r >= queue_[back - 1].radius) --back;  // stops at the front at the latest
      if (queue_[back - 1].end < i + r) queue_[back++] = {i + r, r, *centre};
      *radius = queue_[front].radius;
      *centre = queue_[front].centre;
    }
  }

  std::vector<Ball> queue_;
};

}  // namespace lacuna
