#include "server/connection_pool.h"

#include <pthread.h>

#include <utility>

namespace lacuna {
namespace {

// The HTTP library matches headers, up to 8 KiB long, with recursive regular expressions: that
// takes more than 2 MiB of stack, which is all that a thread gets where the stack limit is
// "unlimited".
constexpr std::size_t stack_bytes = 16 << 20;

void set_default_stack() {
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, stack_bytes);
  pthread_setattr_default_np(&attributes);
  pthread_attr_destroy(&attributes);
}

}  // namespace

ConnectionPool::ConnectionPool(std::size_t threads, std::size_t max_waiting, Serve serve)
    : max_waiting_(max_waiting), serve_(std::move(serve)) {
  set_default_stack();
  for (std::size_t i = 0; i < threads; ++i) threads_.emplace_back([this] { work(); });
}

bool ConnectionPool::offer(FileHandle& connection) {
  {
    const std::lock_guard lock(mutex_);
    if (stopping_ || waiting_.size() >= max_waiting_) return false;
    waiting_.push_back(std::move(connection));
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
    FileHandle connection;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return stopping_ || !waiting_.empty(); });
      if (stopping_) return;
      connection = std::move(waiting_.front());
      waiting_.pop_front();
    }
    serve_(std::move(connection));
  }
}

}  // namespace lacuna
