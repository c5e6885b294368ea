#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "server/reception.h"

namespace lacuna {

/// Threads that each answer one request at a time, and a bounded line of requests that wait.
class ConnectionPool {
 public:
  using Serve = std::function<void(Arrival)>;
  ConnectionPool(std::size_t threads, std::size_t max_waiting, Serve serve);
  ~ConnectionPool() { stop(); }
  ConnectionPool(const ConnectionPool&) = delete;
  ConnectionPool& operator=(const ConnectionPool&) = delete;

  /// Takes the request over, or returns false and leaves it alone: the line is full.
  bool offer(Arrival& arrival);
  /// Drops who waits, and waits for who is served.
  void stop();

 private:
  void work();

  const std::size_t max_waiting_;
  const Serve serve_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Arrival> waiting_;
  bool stopping_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace lacuna
