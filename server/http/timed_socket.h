#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "analysis/storage/file_handle.h"
#include "server/http/http_metrics.h"
#include "server/http/paced_deadline.h"
#include "server/http/slow_seats.h"
#include "server/settings/http_settings.h"

namespace lacuna {

/// A non-blocking connection with deadlines. A thread waits for it on a slow seat while a body
/// arrives and while a response is sent, and without a seat while a stream of texts is open. A
/// client below the minimum rate is disconnected and its thread freed.
class TimedSocket {
 public:
  enum class Pace { total, rate };  ///< a deadline for the whole body, or a least rate

  /// What all connections share; the references outlive them.
  struct Shared {
    const HttpSettings& settings;
    HttpMetrics& metrics;
    SlowSeats& seats;
    int stop_fd;  ///< becomes readable when the service ends: then nothing waits any more
  };

  /// `received`: what has been read of the body already.
  TimedSocket(FileHandle socket, std::string received, const Shared& shared)
      : socket_(std::move(socket)),
        received_(std::move(received)),
        shared_(shared),
        deadline_(shared.settings.body_time) {}

  /// From now on reads are of a body. `invite`: sends "100 Continue" if nothing of it has come.
  void begin_body(Pace pace, bool invite);
  /// As read(2): 0 at the end. Throws HttpError 408 or 503.
  std::size_t read(char* data, std::size_t size);
  /// From now on writes are texts of a stream, which has its thread without a seat.
  void begin_stream() { stream_.emplace(shared_.metrics.streams); }
  /// Sends all of a text, waiting for the client; false if that failed.
  bool write(std::string_view text);
  /// The peer has closed or reset the connection, or the service ends.
  bool gone() const;
  FileHandle release();

 private:
  enum class Wait { ready, late, failed };
  Wait wait(short events, PacedDeadline::Clock::time_point deadline) const;
  void wait_for_body();
  PacedDeadline answer_deadline() const;
  bool wait_for_reader(std::size_t bytes);

  FileHandle socket_;
  std::string received_;
  std::size_t taken_ = 0;  ///< of `received_`
  const Shared& shared_;
  PacedDeadline deadline_;
  SlowSeats::Seat seat_;  // after socket_: goes before it
  std::optional<Counted> stream_;
};

}  // namespace lacuna
