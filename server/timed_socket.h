#pragma once

#include <sys/types.h>

#include <array>
#include <chrono>
#include <cstddef>

#include "analysis/storage/file_handle.h"
#include "server/settings.h"

namespace lacuna {

/// A connection on which every phase has a deadline and a number of bytes: head, body, answer. A
/// client that is slower than that, in whatever rhythm, holds its thread no longer.
class TimedSocket {
 public:
  /// `stop_fd` becomes readable when the service ends: then nothing waits any more.
  TimedSocket(FileHandle socket, int stop_fd, const HttpSettings& settings);

  /// Starts the next phase of reading. `max_bytes` counts what comes over the wire.
  void expect_body(std::size_t max_bytes);
  /// The answer is a stream without an end: each of its texts gets the time of an answer.
  void stream_answer() { streaming_ = true; }

  /// As read(2) and write(2), blocking; -1 on any error and past the deadline.
  ssize_t read(char* data, std::size_t size);
  ssize_t write(const char* data, std::size_t size);

  bool timed_out() const { return timed_out_; }
  /// The peer has closed or reset the connection.
  bool peer_gone() const;
  /// Says that no more will come, and reads what the peer still sends for a short while: closing at
  /// once would reset the connection, and the peer would lose the answer.
  void finish(bool unread_input);

  int fd() const { return socket_.get(); }

 private:
  using Clock = std::chrono::steady_clock;
  bool wait(short events, Clock::time_point deadline);
  void open_window();

  FileHandle socket_;
  int stop_fd_;
  const HttpSettings& settings_;
  Clock::time_point read_deadline_;
  Clock::time_point window_end_;
  std::size_t bytes_left_;
  std::size_t window_bytes_ = 0;
  bool streaming_ = false;
  bool timed_out_ = false;
  std::array<char, 8192> buffer_;
  std::size_t buffered_ = 0, taken_ = 0;
};

}  // namespace lacuna
