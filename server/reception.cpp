#include "server/reception.h"

#include <sys/epoll.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

namespace lacuna {
namespace {

constexpr int accepts_at_a_stretch = 64;
constexpr std::size_t read_bytes = 8192;
// A body of this size is awaited here, where it costs no thread.
constexpr std::size_t small_body_bytes = 16 * 1024;
constexpr int tick_milliseconds = 100;

}  // namespace

Reception::Reception(const Listener& listener, int stop_fd, const HttpSettings& settings,
                     HttpMetrics& metrics, Offer offer, Refuse refuse)
    : listener_(listener),
      settings_(settings),
      metrics_(metrics),
      offer_(std::move(offer)),
      refuse_(std::move(refuse)),
      stop_fd_(stop_fd),
      epoll_(::epoll_create1(EPOLL_CLOEXEC)) {
  watch(listener_.fd(), nullptr);
  watch(stop_fd_, this);
  thread_ = std::thread([this] { run(); });
}

void Reception::join() {
  if (thread_.joinable()) thread_.join();
}

void Reception::watch(int fd, void* tag) const {
  epoll_event event{.events = EPOLLIN | EPOLLRDHUP, .data = {.ptr = tag}};
  if (::epoll_ctl(epoll_.get(), EPOLL_CTL_ADD, fd, &event) != 0) {
    throw std::system_error(errno, std::generic_category(), "cannot wait for connections");
  }
}

void Reception::run() {
  std::array<epoll_event, 256> events;
  auto next_tick = PacedDeadline::Clock::now();
  for (;;) {
    const int n = ::epoll_wait(epoll_.get(), events.data(), static_cast<int>(events.size()),
                               parked_.empty() ? -1 : tick_milliseconds);
    bool accepts = false;
    for (int i = 0; i < n; ++i) {
      void* const tag = events.at(static_cast<std::size_t>(i)).data.ptr;
      if (tag == this) {
        parked_.clear();
        return;
      }
      accepts = accepts || tag == nullptr;
      // Each connection has one event a round, and only that one can end it here.
      if (tag != nullptr) receive(*static_cast<Parked*>(tag), false);
    }
    if (accepts) accept_some();
    if (const auto now = PacedDeadline::Clock::now(); now >= next_tick) {
      expire();
      next_tick = now + std::chrono::milliseconds(tick_milliseconds);
    }
    metrics_.parked = parked_.size();
  }
}

void Reception::accept_some() {
  for (int i = 0; i < accepts_at_a_stretch; ++i) {
    FileHandle connection = listener_.accept();
    if (!connection) {
      // Out of descriptors or memory: the new one stays in the line until an old one has gone.
      const bool full = errno == EMFILE || errno == ENFILE || errno == ENOBUFS || errno == ENOMEM;
      if (full && !parked_.empty()) {
        ++metrics_.refused;
        drop(parked_.front());
      } else if (full) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
      }
      if (!full) return;
      continue;
    }
    ++metrics_.accepted;
    parked_.push_back(
        {std::move(connection), PacedDeadline(settings_.head_time), {}, 0, 0, {}, {}, {}});
    parked_.back().self = std::prev(parked_.end());
    receive(parked_.back(), true);
  }
}

void Reception::receive(Parked& parked, bool is_new) {
  try {
    switch (read(parked)) {
      case State::complete:
        return hand_over(parked);
      case State::gone:
        return drop(parked);
      case State::incomplete:
        if (is_new) watch(parked.socket.get(), &parked);
        if (is_new) make_room();
    }
  } catch (const HttpError& error) {
    refuse(parked, error);
  } catch (const std::system_error&) {
    drop(parked);
  }
}

/// Takes the socket off epoll. Closing does that only where no child that is
/// being started has the socket, too; an event would find nobody here.
FileHandle Reception::release(Parked& parked) const {
  FileHandle socket = std::move(parked.socket);
  ::epoll_ctl(epoll_.get(), EPOLL_CTL_DEL, socket.get(), nullptr);
  return socket;
}

void Reception::drop(Parked& parked) {
  release(parked);
  parked_.erase(parked.self);
}

Reception::State Reception::read(Parked& parked) {
  for (;;) {
    std::array<char, read_bytes> buffer;
    const ssize_t n = ::recv(parked.socket.get(), buffer.data(), buffer.size(), MSG_DONTWAIT);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return errno == EAGAIN ? State::incomplete : State::gone;
    // A client that ends its half before its body is whole learns so from who reads the body.
    if (n == 0) return parked.head_size > 0 ? State::complete : State::gone;
    parked.bytes.append(buffer.data(), static_cast<std::size_t>(n));
    if (is_whole(parked)) return State::complete;
  }
}

/// The head is there and no more of the body is awaited here.
bool Reception::is_whole(Parked& parked) {
  if (parked.head_size == 0) {
    parked.head_size = find_head_end(parked.bytes, parked.searched);
    parked.searched = parked.bytes.size();
    if (parked.head_size == 0) return false;
    parked.head = parse_head(std::string_view(parked.bytes).substr(0, parked.head_size));
    parked.framing = body_framing(parked.head);
    parked.deadline = PacedDeadline(settings_.body_time);
  }
  const bool awaited = !parked.framing.chunked && parked.framing.length <= small_body_bytes &&
                       !parked.head.expects_continue();
  return !awaited || parked.bytes.size() - parked.head_size >= parked.framing.length;
}

void Reception::hand_over(Parked& parked) {
  parked.bytes.erase(0, parked.head_size);
  Arrival arrival{release(parked), std::move(parked.head), parked.framing, std::move(parked.bytes),
                  PacedDeadline::Clock::now()};
  parked_.erase(parked.self);
  if (offer_(arrival)) return;
  ++metrics_.refused;
  refuse_(std::move(arrival.socket),
          HttpError(503, "Too many requests wait to be answered.").with("Retry-After", "1"));
}

void Reception::refuse(Parked& parked, const HttpError& error) {
  FileHandle socket = release(parked);
  parked_.erase(parked.self);
  ++metrics_.refused;
  refuse_(std::move(socket), error);
}

void Reception::expire() {
  for (auto it = parked_.begin(); it != parked_.end();) {
    Parked& parked = *it++;
    if (!parked.deadline.over()) continue;
    if (parked.bytes.empty()) {  // such as a browser's connection in advance
      drop(parked);
      continue;
    }
    refuse(parked, HttpError(408, parked.head_size > 0 ? "The body came too slowly."
                                                       : "The request came too slowly."));
  }
}

/// The oldest goes first: a client that sends its request in one go, as all but slow ones do, is
/// here for no longer than that takes, so newcomers are served however many slow clients there are.
void Reception::make_room() {
  while (parked_.size() > settings_.parked) {
    refuse(parked_.front(),
           HttpError(503, "Too many requests are on their way.").with("Retry-After", "1"));
  }
}

}  // namespace lacuna
