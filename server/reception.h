#pragma once

#include <functional>
#include <list>
#include <string>
#include <thread>

#include "analysis/storage/file_handle.h"
#include "server/http_metrics.h"
#include "server/listener.h"
#include "server/paced_deadline.h"
#include "server/request_head.h"
#include "server/settings.h"

namespace lacuna {

/// A request that has come: its head, and of its body what came with it; all of it if it is small.
struct Arrival {
  FileHandle socket;
  RequestHead head;
  BodyFraming framing;
  std::string body;
  PacedDeadline::Clock::time_point time;
};

/// Accepts connections and keeps them until their request is there, on one thread for all of them:
/// who sends slowly holds up nobody.
class Reception {
 public:
  /// Takes the arrival over, or returns false and leaves it alone: there is no room.
  using Offer = std::function<bool(Arrival&)>;
  using Refuse = std::function<void(FileHandle, const HttpError&)>;

  /// The references outlive it; both functions are called on its thread and may not wait. Throws
  /// std::system_error.
  Reception(const Listener& listener, int stop_fd, const HttpSettings& settings,
            HttpMetrics& metrics, Offer offer, Refuse refuse);
  /// Once stop_fd is readable.
  void join();

 private:
  /// In the order in which they came.
  struct Parked {
    FileHandle socket;
    PacedDeadline deadline;
    std::string bytes;
    std::size_t searched = 0;   ///< of `bytes`, for the end of the head
    std::size_t head_size = 0;  ///< 0: has not come yet
    RequestHead head;
    BodyFraming framing;
    std::list<Parked>::iterator self;
  };
  enum class State { incomplete, complete, gone };

  void watch(int fd, void* tag) const;
  void run();
  void accept_some();
  void receive(Parked& parked, bool is_new);
  State read(Parked& parked);
  bool is_whole(Parked& parked);
  FileHandle release(Parked& parked) const;
  void drop(Parked& parked);
  void hand_over(Parked& parked);
  void refuse(Parked& parked, const HttpError& error);
  void expire();
  void make_room();

  const Listener& listener_;
  const HttpSettings& settings_;
  HttpMetrics& metrics_;
  const Offer offer_;
  const Refuse refuse_;
  const int stop_fd_;
  const FileHandle epoll_;
  std::list<Parked> parked_;
  std::thread thread_;
};

}  // namespace lacuna
