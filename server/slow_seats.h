#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>

namespace lacuna {

/// How many threads may wait for their client at a time.
class SlowSeats {
 public:
  /// `taken` counts them and outlives it.
  SlowSeats(std::size_t seats, std::atomic<std::uint64_t>& taken) : seats_(seats), taken_(taken) {}

  struct Leave {
    void operator()(SlowSeats* seats) const { --seats->taken_; }
  };
  /// Is given back when it goes.
  using Seat = std::unique_ptr<SlowSeats, Leave>;
  /// Empty if none is free.
  Seat take() {
    if (++taken_ <= seats_) return Seat(this);
    --taken_;
    return {};
  }

 private:
  const std::size_t seats_;
  std::atomic<std::uint64_t>& taken_;
};

}  // namespace lacuna
