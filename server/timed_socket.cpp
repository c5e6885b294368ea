#include "server/timed_socket.h"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

namespace lacuna {
namespace {

constexpr std::size_t max_head_bytes = 64 * 1024;
constexpr std::chrono::milliseconds drain_time{1000};

}  // namespace

TimedSocket::TimedSocket(FileHandle socket, int stop_fd, const HttpSettings& settings)
    : socket_(std::move(socket)),
      stop_fd_(stop_fd),
      settings_(settings),
      read_deadline_(Clock::now() + settings.head_time),
      bytes_left_(max_head_bytes) {}

void TimedSocket::expect_body(std::size_t max_bytes) {
  read_deadline_ = Clock::now() + settings_.body_time;
  bytes_left_ = max_bytes;
}

bool TimedSocket::wait(short events, Clock::time_point deadline) {
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now()).count();
    if (left <= 0) {
      timed_out_ = true;
      return false;
    }
    std::array<pollfd, 2> fds{{{socket_.get(), events, 0}, {stop_fd_, POLLIN, 0}}};
    const int ready = ::poll(fds.data(), fds.size(), static_cast<int>(left));
    if (ready < 0 && errno != EINTR) return false;
    if (ready <= 0) continue;
    if (fds[0].revents != 0) return true;
    return false;  // the service ends
  }
}

ssize_t TimedSocket::read(char* data, std::size_t size) {
  while (taken_ == buffered_) {
    const std::size_t room = std::min(buffer_.size(), bytes_left_);
    if (room == 0 || !wait(POLLIN, read_deadline_)) return -1;
    const ssize_t n = ::recv(socket_.get(), buffer_.data(), room, MSG_DONTWAIT);
    if (n < 0 && (errno == EAGAIN || errno == EINTR)) continue;
    if (n <= 0) return n;
    bytes_left_ -= static_cast<std::size_t>(n);
    buffered_ = static_cast<std::size_t>(n);
    taken_ = 0;
  }
  const std::size_t n = std::min(size, buffered_ - taken_);
  std::memcpy(data, buffer_.data() + taken_, n);
  taken_ += n;
  return static_cast<ssize_t>(n);
}

ssize_t TimedSocket::write(const char* data, std::size_t size) {
  if (window_end_ == Clock::time_point() || streaming_) open_window();
  for (;;) {
    const ssize_t n = ::send(socket_.get(), data, size, MSG_DONTWAIT | MSG_NOSIGNAL);
    if (n >= 0) {
      window_bytes_ += static_cast<std::size_t>(n);
      return n;
    }
    if (errno == EINTR) continue;
    if (errno != EAGAIN) return -1;
    // Here the peer is what is slow: it must take enough in each window, however much it took
    // before.
    const bool took_enough = window_bytes_ >= settings_.answer_bytes;
    if (Clock::now() >= window_end_ && took_enough) open_window();
    if (!wait(POLLOUT, window_end_) && !(timed_out_ && took_enough)) return -1;
    timed_out_ = false;
  }
}

void TimedSocket::open_window() {
  window_end_ = Clock::now() + settings_.answer_time;
  window_bytes_ = 0;
}

bool TimedSocket::peer_gone() const {
  char byte = 0;
  const ssize_t n = ::recv(socket_.get(), &byte, 1, MSG_PEEK | MSG_DONTWAIT);
  return n == 0 || (n < 0 && errno != EAGAIN && errno != EINTR);
}

void TimedSocket::finish(bool unread_input) {
  ::shutdown(socket_.get(), SHUT_WR);
  if (unread_input) {
    const auto deadline = Clock::now() + drain_time;
    while (wait(POLLIN, deadline)) {
      const ssize_t n = ::recv(socket_.get(), buffer_.data(), buffer_.size(), MSG_DONTWAIT);
      if (n == 0 || (n < 0 && errno != EAGAIN && errno != EINTR)) break;
    }
  }
  socket_.close();
}

}  // namespace lacuna
