#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "analysis/storage/file_handle.h"

namespace lacuna {

/// Threads that each serve one connection at a time, and a bounded line of connections that wait.
class ConnectionPool {
 public:
  using Serve = std::function<void(FileHandle)>;
  ConnectionPool(std::size_t threads, std::size_t max_waiting, Serve serve);
  ~ConnectionPool() { stop(); }
  ConnectionPool(const ConnectionPool&) = delete;
  ConnectionPool& operator=(const ConnectionPool&) = delete;

  /// Takes the connection over, or returns false and leaves it alone: the line is full.
  bool offer(FileHandle& connection);
  /// Drops who waits, and waits for who is served.
  void stop();

 private:
  void work();

  const std::size_t max_waiting_;
  const Serve serve_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<FileHandle> waiting_;
  bool stopping_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace lacuna
