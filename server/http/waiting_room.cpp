#include "server/http/waiting_room.h"

#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

namespace lacuna {
namespace {

using Clock = PacedDeadline::Clock;

constexpr int accepts_at_a_stretch = 64;
constexpr std::size_t read_bytes = 8192;
// A body of this size is awaited here, where it costs no thread.
constexpr std::size_t small_body_bytes = 16 * 1024;
// Else clients that take nothing could each hold megabytes of the kernel's memory.
constexpr int send_buffer = 256 * 1024;
constexpr std::chrono::milliseconds linger_time{1000};
constexpr int tick_milliseconds = 100;

/// The next connection, not blocking, and closed in child processes; empty, with errno, if there is
/// none.
FileHandle accept_one(int listener) {
  FileHandle connection(::accept4(listener, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
  if (connection) {
    const int yes = 1;  // answers and events are written whole: nothing to wait for
    ::setsockopt(connection.get(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    ::setsockopt(connection.get(), SOL_SOCKET, SO_SNDBUF, &send_buffer, sizeof send_buffer);
  }
  return connection;
}

}  // namespace

WaitingRoom::WaitingRoom(int listener, const HttpSettings& settings, HttpMetrics& metrics,
                         Offer offer, Refusal refusal)
    : listener_(listener),
      settings_(settings),
      metrics_(metrics),
      offer_(std::move(offer)),
      refusal_(std::move(refusal)),
      epoll_(::epoll_create1(EPOLL_CLOEXEC)),
      wake_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (!watch(listener_, nullptr) || !watch(wake_.get(), this)) {
    throw std::system_error(errno, std::generic_category(), "cannot wait for clients");
  }
  thread_ = std::jthread([this](const std::stop_token& ends) { run(ends); });
}

WaitingRoom::~WaitingRoom() {
  thread_.request_stop();
  ::eventfd_write(wake_.get(), 1);
  thread_.join();
}

void WaitingRoom::linger(FileHandle socket) {
  ::shutdown(socket.get(), SHUT_WR);
  {
    const std::lock_guard lock(mutex_);
    inbox_.push_back(std::move(socket));
  }
  ::eventfd_write(wake_.get(), 1);
}

bool WaitingRoom::watch(int fd, void* tag) const {
  epoll_event event{.events = EPOLLIN | EPOLLRDHUP, .data = {.ptr = tag}};
  return ::epoll_ctl(epoll_.get(), EPOLL_CTL_ADD, fd, &event) == 0;
}

void WaitingRoom::run(const std::stop_token& ends) {
  std::array<epoll_event, 256> events;
  auto next_tick = Clock::now();
  while (!ends.stop_requested()) {
    const bool idle = arriving_.empty() && lingering_.empty();
    const int n = ::epoll_wait(epoll_.get(), events.data(), static_cast<int>(events.size()),
                               idle ? -1 : tick_milliseconds);
    bool accepts = false;
    for (int i = 0; i < n; ++i) {
      void* const tag = events.at(static_cast<std::size_t>(i)).data.ptr;
      accepts = accepts || tag == nullptr;
      // Each client has one event a round, and until all are looked at only that one can end it.
      if (tag != nullptr && tag != this) receive(*static_cast<Client*>(tag), false);
    }
    if (accepts) accept_some();
    take_in();
    if (const auto now = Clock::now(); now >= next_tick) {
      expire();
      next_tick = now + std::chrono::milliseconds(tick_milliseconds);
    }
    metrics_.parked = arriving_.size();
  }
}

WaitingRoom::Client& WaitingRoom::enter(std::list<Client>& list, FileHandle socket,
                                        PacedDeadline deadline) {
  list.push_back({&list, std::move(socket), deadline});
  list.back().self = std::prev(list.end());
  return list.back();
}

/// Takes the client off epoll and out of the room; gives its socket. Closing does that only where
/// no child that is being started has the socket, too; an event would find nobody here.
FileHandle WaitingRoom::leave(Client& client) {
  FileHandle socket = std::move(client.socket);
  ::epoll_ctl(epoll_.get(), EPOLL_CTL_DEL, socket.get(), nullptr);
  client.in->erase(client.self);
  return socket;
}

void WaitingRoom::accept_some() {
  for (int i = 0; i < accepts_at_a_stretch; ++i) {
    FileHandle connection = accept_one(listener_);
    if (!connection) {
      // Out of descriptors or memory: the new one stays in the line until an old one has gone.
      const bool full = errno == EMFILE || errno == ENFILE || errno == ENOBUFS || errno == ENOMEM;
      if (full && !arriving_.empty()) {
        ++metrics_.refused;
        leave(arriving_.front());
      } else if (full) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
      }
      if (!full) return;
      continue;
    }
    ++metrics_.accepted;
    if (connection.get() > settings_.max_connection_fd) {
      if (!keep_reserve()) {
        ++metrics_.refused;  // without a word: it is closed
        continue;
      }
      // The number that has become free: or each second newcomer would get it and be let in beside.
      connection = FileHandle(::fcntl(connection.get(), F_DUPFD_CLOEXEC, 0));
    }
    receive(enter(arriving_, std::move(connection), PacedDeadline(settings_.head_time)), true);
  }
}

/// Closes the connection that can be done without most, for a new one: its number says that all
/// below, as they are given out, are in use. False: there is none.
bool WaitingRoom::keep_reserve() {
  std::list<Client>& list = lingering_.empty() ? arriving_ : lingering_;
  if (list.empty()) return false;
  if (&list == &arriving_) {
    ++metrics_.refused;
    const std::string text =
        refusal_(HttpError(503, "Too many connections are open.").with("Retry-After", "1"));
    ::send(list.front().socket.get(), text.data(), text.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
  }
  leave(list.front());
  return true;
}

void WaitingRoom::receive(Client& client, bool is_new) {
  try {
    switch (read(client)) {
      case State::complete:
        return hand_over(client);
      case State::gone:
        leave(client);
        return;
      case State::incomplete:
        if (is_new && !watch(client.socket.get(), &client)) {
          leave(client);
          return;
        }
        if (is_new) make_room();
    }
  } catch (const HttpError& error) {
    refuse(leave(client), error);
  }
}

WaitingRoom::State WaitingRoom::read(Client& client) const {
  for (;;) {
    std::array<char, read_bytes> buffer;
    const ssize_t n = ::recv(client.socket.get(), buffer.data(), buffer.size(), MSG_DONTWAIT);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return errno == EAGAIN ? State::incomplete : State::gone;
    // A client that ends its half before its body is whole learns so from who reads the body.
    if (n == 0) return client.head ? State::complete : State::gone;
    if (client.in == &lingering_) return State::incomplete;  // one at a time: some never end
    client.bytes.append(buffer.data(), static_cast<std::size_t>(n));
    if (is_whole(client)) return State::complete;
  }
}

/// The head is there and no more of the body is awaited here.
bool WaitingRoom::is_whole(Client& client) const {
  if (!client.head) {
    client.head_size = find_head_end(client.bytes, client.searched);
    client.searched = client.bytes.size();
    if (client.head_size == 0) return false;
    client.head = check_head(std::string_view(client.bytes).substr(0, client.head_size));
    client.deadline = PacedDeadline(settings_.body_time);
  }
  const RequestHead& head = *client.head;
  const bool awaited = !head.chunked && head.length <= small_body_bytes && !head.expects_continue;
  return !awaited || client.bytes.size() - client.head_size >= head.length;
}

void WaitingRoom::hand_over(Client& client) {
  client.bytes.erase(0, client.head_size);
  Arrival arrival{{}, std::move(*client.head), std::move(client.bytes), Clock::now()};
  arrival.socket = leave(client);
  if (offer_(arrival)) return;
  refuse(std::move(arrival.socket),
         HttpError(503, "Too many requests are waiting.").with("Retry-After", "1"));
}

void WaitingRoom::refuse(FileHandle socket, const HttpError& error) {
  ++metrics_.refused;
  const std::string text = refusal_(error);  // short: it fits into the connection's buffer
  if (::send(socket.get(), text.data(), text.size(), MSG_DONTWAIT | MSG_NOSIGNAL) > 0) {
    linger(std::move(socket));
  }
}

void WaitingRoom::expire() {
  for (auto it = arriving_.begin(); it != arriving_.end();) {
    Client& client = *it++;
    if (!client.deadline.over()) continue;
    if (client.bytes.empty()) {  // such as a browser's connection in advance
      leave(client);
      continue;
    }
    const char* const what =
        client.head ? "The body arrived too slowly." : "The request arrived too slowly.";
    refuse(leave(client), HttpError(408, what));
  }
  while (!lingering_.empty() && lingering_.front().deadline.over()) leave(lingering_.front());
}

void WaitingRoom::take_in() {
  std::vector<FileHandle> fresh;
  {
    const std::lock_guard lock(mutex_);
    std::swap(fresh, inbox_);
  }
  eventfd_t count = 0;
  ::eventfd_read(wake_.get(), &count);
  for (FileHandle& socket : fresh) {
    receive(enter(lingering_, std::move(socket), PacedDeadline(linger_time)), true);
  }
}

/// The oldest goes first: a client that sends its request in one go, as all but slow ones do, is
/// here for no longer than that takes, so newcomers are served however many slow clients there are.
void WaitingRoom::make_room() {
  while (arriving_.size() > settings_.parked) {
    refuse(leave(arriving_.front()),
           HttpError(503, "Too many requests are arriving.").with("Retry-After", "1"));
  }
  while (lingering_.size() > settings_.parked) leave(lingering_.front());
}

}  // namespace lacuna
