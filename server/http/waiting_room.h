#pragma once

#include <functional>
#include <list>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "analysis/storage/file_handle.h"
#include "server/http/http_metrics.h"
#include "server/http/message.h"
#include "server/http/paced_deadline.h"
#include "server/http/request_head.h"
#include "server/settings/http_settings.h"

namespace lacuna {

/// An arrived request: its head, and the part of the body that came with it; a small body entirely.
struct Arrival {
  FileHandle socket;
  RequestHead head;
  std::string body;
  PacedDeadline::Clock::time_point time;
};

/// Accepts connections and holds them until their request has arrived, on one thread for all, so
/// slow senders delay nobody. Also holds connections whose response is sent but that still send:
/// closing them at once would reset the connection and lose the response.
class WaitingRoom {
 public:
  /// Takes the arrival over, or returns false and leaves it alone: there is no room.
  using Offer = std::function<bool(Arrival&)>;
  /// The whole text of the answer to what is no request, or one too many.
  using Refusal = std::function<std::string(const HttpError&)>;

  /// Accepts on `listener`, a non-blocking socket. The references outlive it; the functions are
  /// called on its thread and may not wait. Throws std::system_error.
  WaitingRoom(int listener, const HttpSettings& settings, HttpMetrics& metrics, Offer offer,
              Refusal refusal);
  ~WaitingRoom();
  WaitingRoom(const WaitingRoom&) = delete;
  WaitingRoom& operator=(const WaitingRoom&) = delete;

  /// Waits a little for the end of what the client sends, and closes. Any thread.
  void linger(FileHandle socket);

 private:
  struct Client {
    std::list<Client>* in;
    FileHandle socket;
    PacedDeadline deadline;
    std::string bytes = {};
    std::size_t searched = 0;  ///< of `bytes`, for the end of the head
    std::size_t head_size = 0;
    std::optional<RequestHead> head = {};  ///< once it has come
    std::list<Client>::iterator self = {};
  };
  enum class State { incomplete, complete, gone };

  void run(const std::stop_token& ends);
  bool watch(int fd, void* tag) const;
  Client& enter(std::list<Client>& list, FileHandle socket, PacedDeadline deadline);
  FileHandle leave(Client& client);
  void accept_some();
  bool keep_reserve();
  void receive(Client& client, bool is_new);
  State read(Client& client) const;
  bool is_whole(Client& client) const;
  void hand_over(Client& client);
  void refuse(FileHandle socket, const HttpError& error);
  void take_in();
  void expire();
  void make_room();

  const int listener_;
  const HttpSettings& settings_;
  HttpMetrics& metrics_;
  const Offer offer_;
  const Refusal refusal_;
  const FileHandle epoll_, wake_;
  std::mutex mutex_;
  std::vector<FileHandle> inbox_;
  // For the own thread only, in the order in which they came:
  std::list<Client> arriving_, lingering_;
  std::jthread thread_;
};

}  // namespace lacuna
