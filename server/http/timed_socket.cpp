#include "server/http/timed_socket.h"

#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>

#include "server/http/message.h"

namespace lacuna {

void TimedSocket::begin_body(Pace pace, bool invite) {
  const HttpSettings& s = shared_.settings;
  deadline_ =
      pace == Pace::total ? PacedDeadline(s.body_time) : PacedDeadline(s.body_time, s.body_bytes);
  constexpr std::string_view go_on = "HTTP/1.1 100 Continue\r\n\r\n";
  if (invite && received_.empty()) {
    ::send(socket_.get(), go_on.data(), go_on.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
  }
}

TimedSocket::Wait TimedSocket::wait(short events, PacedDeadline::Clock::time_point deadline) const {
  for (;;) {
    const auto left =
        std::chrono::ceil<std::chrono::milliseconds>(deadline - PacedDeadline::Clock::now());
    if (left.count() <= 0) return Wait::late;
    std::array<pollfd, 2> fds{{{socket_.get(), events, 0}, {shared_.stop_fd, POLLIN, 0}}};
    const int ready = ::poll(fds.data(), fds.size(), static_cast<int>(left.count()));
    if (ready < 0 && errno != EINTR) return Wait::failed;
    if (ready <= 0) continue;
    return fds[0].revents != 0 ? Wait::ready : Wait::failed;  // failed: the service ends
  }
}

void TimedSocket::wait_for_body() {
  if (!seat_) seat_ = shared_.seats.for_body(socket_.get());
  if (!seat_) {
    throw HttpError(503, "Too many slow clients are sending at present.").with("Retry-After", "5");
  }
  const Wait result = wait(POLLIN, deadline_.end());
  if (result == Wait::late && deadline_.over())
    throw HttpError(408, "The body arrived too slowly.");
  if (result == Wait::failed) throw HttpError(503, "The service is shutting down.");
}

std::size_t TimedSocket::read(char* data, std::size_t size) {
  if (taken_ < received_.size()) {
    const std::size_t n = received_.copy(data, size, taken_);
    taken_ += n;
    return n;
  }
  for (;;) {
    if (deadline_.over()) throw HttpError(408, "The body arrived too slowly.");
    const ssize_t n = ::recv(socket_.get(), data, size, MSG_DONTWAIT);
    if (n >= 0) {
      deadline_.count(static_cast<std::size_t>(n));
      return static_cast<std::size_t>(n);
    }
    if (errno == EINTR) continue;
    if (errno != EAGAIN) return 0;  // reset: as good as closed
    wait_for_body();
  }
}

PacedDeadline TimedSocket::answer_deadline() const {
  return PacedDeadline(shared_.settings.answer_time, shared_.settings.answer_bytes);
}

bool TimedSocket::wait_for_reader(std::size_t bytes) {
  if (!seat_ && !stream_) {
    seat_ = shared_.seats.for_reader(socket_.get(), bytes);
    deadline_ = answer_deadline();
  }
  if (!seat_ && !stream_) return false;
  const Wait result = wait(POLLOUT, deadline_.end());
  return result == Wait::ready || (result == Wait::late && !deadline_.over());
}

bool TimedSocket::write(std::string_view text) {
  if (stream_) deadline_ = answer_deadline();  // of each text anew
  if (seat_ && !seat_->reads) seat_.reset();   // its body has come
  while (!text.empty()) {
    const ssize_t n = ::send(socket_.get(), text.data(), text.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
    if (n >= 0) {
      text.remove_prefix(static_cast<std::size_t>(n));
      deadline_.count(static_cast<std::size_t>(n));
      shared_.metrics.bytes_out += static_cast<std::uint64_t>(n);
      if (seat_) shared_.seats.moved_on(*seat_);
    } else if (errno == EAGAIN) {
      if (!wait_for_reader(text.size())) {
        ++shared_.metrics.given_up;
        return false;
      }
    } else if (errno != EINTR) {
      return false;
    }
  }
  return true;
}

bool TimedSocket::gone() const {
  pollfd stop{shared_.stop_fd, POLLIN, 0};
  if (::poll(&stop, 1, 0) > 0) return true;
  char byte = 0;
  const ssize_t n = ::recv(socket_.get(), &byte, 1, MSG_PEEK | MSG_DONTWAIT);
  return n == 0 || (n < 0 && errno != EAGAIN && errno != EINTR);
}

FileHandle TimedSocket::release() {
  seat_.reset();
  return std::move(socket_);
}

}  // namespace lacuna
