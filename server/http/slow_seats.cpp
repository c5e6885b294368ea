#include "server/http/slow_seats.h"

#include <sys/socket.h>

#include <algorithm>

namespace lacuna {

SlowSeats::Seat SlowSeats::for_body(int socket) {
  const std::lock_guard lock(mutex_);
  if (metrics_.slow_seats >= seats_) return {};
  return add({.seats = this, .socket = socket, .bytes = 0, .reads = false});
}

SlowSeats::Seat SlowSeats::for_reader(int socket, std::size_t bytes) {
  const std::lock_guard lock(mutex_);
  while (metrics_.slow_seats >= seats_ || bytes_ + bytes > max_bytes_) {
    if (!shut_one()) return {};
  }
  return add({.seats = this, .socket = socket, .bytes = bytes, .reads = true});
}

SlowSeats::Seat SlowSeats::add(const Holder& holder) {
  ++metrics_.slow_seats;
  bytes_ += holder.bytes;
  holders_.push_back(holder);
  holders_.back().self = std::prev(holders_.end());
  return Seat(&holders_.back());
}

bool SlowSeats::shut_one() {
  const auto first = std::find_if(holders_.begin(), holders_.end(),
                                  [](const Holder& h) { return h.reads && !h.shut; });
  if (first == holders_.end()) return false;
  ::shutdown(first->socket, SHUT_RDWR);  // its thread sees that, and goes
  first->shut = true;
  ++metrics_.given_up;
  --metrics_.slow_seats;
  bytes_ -= first->bytes;
  return true;
}

void SlowSeats::moved_on(Holder& reader) {
  const std::lock_guard lock(mutex_);
  holders_.splice(holders_.end(), holders_, reader.self);
}

void SlowSeats::leave(Holder& holder) {
  const std::lock_guard lock(mutex_);
  if (!holder.shut) {
    --metrics_.slow_seats;
    bytes_ -= holder.bytes;
  }
  holders_.erase(holder.self);
}

}  // namespace lacuna
