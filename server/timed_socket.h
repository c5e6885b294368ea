#pragma once

#include <string>
#include <string_view>

#include "analysis/storage/file_handle.h"
#include "server/body_reader.h"
#include "server/paced_deadline.h"
#include "server/settings.h"
#include "server/slow_seats.h"

namespace lacuna {

/// A connection that a thread waits for: while a body comes, with a deadline and one of the slow
/// seats, and for as long as a stream of texts is open. A client that is slower than that, in
/// whatever rhythm, holds its thread no longer.
class TimedSocket : public ByteSource {
 public:
  /// `received`: what has been read of the body already. `stop_fd` becomes readable when the
  /// service ends: then nothing waits any more. The references outlive it.
  TimedSocket(FileHandle socket, std::string received, int stop_fd, const HttpSettings& settings,
              SlowSeats& seats);

  /// Sends "100 Continue" when the body is asked for and nothing of it has come.
  void expect_continue() { expect_continue_ = true; }
  void begin_body(Pace pace) override;
  void end_body() override { seat_.reset(); }
  std::size_t read(char* data, std::size_t size) override;

  /// Sends a text of a stream, waiting for the client; false if that failed.
  bool write(std::string_view text);
  /// The peer has closed or reset the connection.
  bool peer_gone() const;
  /// The service ends.
  bool stopping() const;
  FileHandle release() { return std::move(socket_); }

 private:
  enum class Wait { ready, late, failed };
  Wait wait(short events, PacedDeadline::Clock::time_point deadline) const;
  void wait_for_body();

  FileHandle socket_;
  std::string received_;
  std::size_t taken_ = 0;
  int stop_fd_;
  const HttpSettings& settings_;
  SlowSeats& seats_;
  SlowSeats::Seat seat_;
  PacedDeadline body_deadline_;
  bool expect_continue_ = false;
};

}  // namespace lacuna
