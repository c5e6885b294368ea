#pragma once

#include <atomic>
#include <cstddef>
#include <list>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "analysis/storage/file_handle.h"
#include "server/http_metrics.h"
#include "server/message.h"
#include "server/paced_deadline.h"
#include "server/settings.h"

namespace lacuna {

/// An answer on its way: a text and then a part of a file.
struct Outgoing {
  FileHandle socket;
  std::string text;
  std::size_t sent = 0;  ///< of the text
  std::optional<FilePart> file;
  /// Something that the client sends is not read: closing at once would reset the connection, and
  /// the client would lose the answer.
  bool unread_input = false;
};

/// Sends answers. What a client takes at once goes out on the caller's thread; all clients that are
/// slow to take theirs share one thread of its own, so that none of them holds up anything else.
class Delivery {
 public:
  /// The references outlive it. Throws std::system_error.
  Delivery(const HttpSettings& settings, HttpMetrics& metrics);
  ~Delivery() { stop(); }
  Delivery(const Delivery&) = delete;
  Delivery& operator=(const Delivery&) = delete;

  /// Never waits for the client. Any thread.
  void send(Outgoing answer);
  /// Cuts off what has not been taken yet.
  void stop();

 private:
  struct Item;
  using Items = std::list<Item>;
  struct Item {
    Outgoing answer;
    PacedDeadline deadline;
    Items* in;
    Items::iterator self;
  };
  enum class Sent { all, more, failed };

  Sent send_some(Outgoing& answer, std::size_t limit);
  ssize_t send_part(Outgoing& answer, std::size_t limit);
  bool finished(Outgoing& answer) const;
  void run();
  void take_in();
  void add(Outgoing answer);
  void serve(Item& item);
  void begin_to_linger(Item& item);
  void linger(Item& item);
  void expire();
  void make_room();
  void drop(Item& item, bool given_up);

  const HttpSettings& settings_;
  HttpMetrics& metrics_;
  const FileHandle epoll_, wake_;
  std::mutex mutex_;
  std::vector<Outgoing> inbox_;
  std::atomic<bool> stopping_{false};
  // From here on: for the own thread only.
  Items sending_;    ///< in the order in which they last took something: who takes nothing is first
  Items lingering_;  ///< all is sent, and the end of what the client sends is awaited
  std::size_t bytes_ = 0;  ///< of the texts that are being sent
  std::thread thread_;
};

}  // namespace lacuna
