#include "server/connection_pool.h"

#include <utility>

namespace lacuna {

ConnectionPool::ConnectionPool(std::size_t threads, std::size_t max_waiting, Serve serve)
    : max_waiting_(max_waiting), serve_(std::move(serve)) {
  for (std::size_t i = 0; i < threads; ++i) threads_.emplace_back([this] { work(); });
}

bool ConnectionPool::offer(Arrival& arrival) {
  {
    const std::lock_guard lock(mutex_);
    if (stopping_ || waiting_.size() >= max_waiting_) return false;
    waiting_.push_back(std::move(arrival));
  }
  changed_.notify_one();
  return true;
}

void ConnectionPool::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    waiting_.clear();
  }
  changed_.notify_all();
  for (std::thread& t : threads_) {
    if (t.joinable()) t.join();
  }
}

void ConnectionPool::work() {
  for (;;) {
    Arrival arrival;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return stopping_ || !waiting_.empty(); });
      if (stopping_) return;
      arrival = std::move(waiting_.front());
      waiting_.pop_front();
    }
    serve_(std::move(arrival));
  }
}

}  // namespace lacuna
