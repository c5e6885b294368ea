#pragma once

#include <cstddef>
#include <list>
#include <memory>
#include <mutex>

#include "server/http/http_metrics.h"

namespace lacuna {

/// Limits the number of threads that wait for slow clients, and the memory of the responses that
/// they hold. Thread-safe.
class SlowSeats {
 public:
  struct Holder {
    SlowSeats* seats;
    int socket;
    std::size_t bytes;  ///< of the answer in memory
    bool reads;         ///< false: it sends a body
    bool shut = false;  ///< it was sent away and has not gone yet
    std::list<Holder>::iterator self = {};
  };
  struct Leave {
    void operator()(Holder* holder) const { holder->seats->leave(*holder); }
  };
  /// Is given back when it goes, before its socket is closed.
  using Seat = std::unique_ptr<Holder, Leave>;

  /// `metrics` counts the seats that are taken and the readers sent away, and outlives it.
  SlowSeats(std::size_t seats, std::size_t max_bytes, HttpMetrics& metrics)
      : seats_(seats), max_bytes_(max_bytes), metrics_(metrics) {}

  /// A seat for a client that sends a body; empty if none is free.
  Seat for_body(int socket);
  /// A seat for a client that reads a response slowly. If none is free, closes the connection of
  /// the reader that has been idle for longest, so clients with a slow but steady connection stay.
  /// Empty if that does not free a seat.
  Seat for_reader(int socket, std::size_t bytes);
  /// Call when a reader has received data.
  void moved_on(Holder& reader);

 private:
  Seat add(const Holder& holder);
  void leave(Holder& holder);
  bool shut_one();

  const std::size_t seats_, max_bytes_;
  HttpMetrics& metrics_;
  std::mutex mutex_;
  std::list<Holder> holders_;  ///< in the order in which readers last took something
  std::size_t bytes_ = 0;
};

}  // namespace lacuna
