#include "server/timed_socket.h"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

namespace lacuna {

TimedSocket::TimedSocket(FileHandle socket, std::string received, int stop_fd,
                         const HttpSettings& settings, SlowSeats& seats)
    : socket_(std::move(socket)),
      received_(std::move(received)),
      stop_fd_(stop_fd),
      settings_(settings),
      seats_(seats),
      body_deadline_(settings.body_time) {}

void TimedSocket::begin_body(Pace pace) {
  body_deadline_ = pace == Pace::total ? PacedDeadline(settings_.body_time)
                                       : PacedDeadline(settings_.body_time, settings_.body_bytes);
  constexpr std::string_view go_on = "HTTP/1.1 100 Continue\r\n\r\n";
  if (std::exchange(expect_continue_, false) && received_.empty()) {
    ::send(socket_.get(), go_on.data(), go_on.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
  }
}

TimedSocket::Wait TimedSocket::wait(short events, PacedDeadline::Clock::time_point deadline) const {
  for (;;) {
    const auto left =
        std::chrono::ceil<std::chrono::milliseconds>(deadline - PacedDeadline::Clock::now());
    if (left.count() <= 0) return Wait::late;
    std::array<pollfd, 2> fds{{{socket_.get(), events, 0}, {stop_fd_, POLLIN, 0}}};
    const int ready = ::poll(fds.data(), fds.size(), static_cast<int>(left.count()));
    if (ready < 0 && errno != EINTR) return Wait::failed;
    if (ready <= 0) continue;
    return fds[0].revents != 0 ? Wait::ready : Wait::failed;  // failed: the service ends
  }
}

void TimedSocket::wait_for_body() {
  if (!seat_) seat_ = seats_.take();
  if (!seat_) {
    throw HttpError(503, "Too many clients send slowly at present.").with("Retry-After", "5");
  }
  const Wait result = wait(POLLIN, body_deadline_.end());
  if (result == Wait::late && body_deadline_.over()) {
    throw HttpError(408, "The body came too slowly.");
  }
  if (result == Wait::failed) throw HttpError(503, "The service ends.");
}

std::size_t TimedSocket::read(char* data, std::size_t size) {
  if (taken_ < received_.size()) {
    const std::size_t n = received_.copy(data, size, taken_);
    taken_ += n;
    return n;
  }
  for (;;) {
    if (body_deadline_.over()) throw HttpError(408, "The body came too slowly.");
    const ssize_t n = ::recv(socket_.get(), data, size, MSG_DONTWAIT);
    if (n >= 0) {
      body_deadline_.count(static_cast<std::size_t>(n));
      return static_cast<std::size_t>(n);
    }
    if (errno == EINTR) continue;
    if (errno != EAGAIN) return 0;  // reset: as good as closed
    wait_for_body();
  }
}

bool TimedSocket::write(std::string_view text) {
  PacedDeadline deadline(settings_.answer_time, settings_.answer_bytes);
  while (!text.empty()) {
    const ssize_t n = ::send(socket_.get(), text.data(), text.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
    if (n >= 0) {
      deadline.count(static_cast<std::size_t>(n));
      text.remove_prefix(static_cast<std::size_t>(n));
    } else if (errno == EAGAIN) {
      const Wait result = wait(POLLOUT, deadline.end());
      if (result == Wait::failed || (result == Wait::late && deadline.over())) return false;
    } else if (errno != EINTR) {
      return false;
    }
  }
  return true;
}

bool TimedSocket::stopping() const {
  pollfd stop{stop_fd_, POLLIN, 0};
  return ::poll(&stop, 1, 0) > 0;
}

bool TimedSocket::peer_gone() const {
  char byte = 0;
  const ssize_t n = ::recv(socket_.get(), &byte, 1, MSG_PEEK | MSG_DONTWAIT);
  return n == 0 || (n < 0 && errno != EAGAIN && errno != EINTR);
}

}  // namespace lacuna
