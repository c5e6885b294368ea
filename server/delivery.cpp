#include "server/delivery.h"

#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <sys/sendfile.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

namespace lacuna {
namespace {

// A thread that answers requests sends this much at a stretch, and so does each turn of the thread
// for slow clients.
constexpr std::size_t first_bytes = 1 << 20;
constexpr std::size_t turn_bytes = 256 * 1024;
constexpr std::chrono::milliseconds linger_time{1000};
constexpr int tick_milliseconds = 100;

/// Bytes that are still to be sent.
std::uint64_t left(const Outgoing& answer) {
  const auto of_file = answer.file ? static_cast<std::uint64_t>(answer.file->length) : 0;
  return answer.text.size() - answer.sent + of_file;
}

}  // namespace

Delivery::Delivery(const HttpSettings& settings, HttpMetrics& metrics)
    : settings_(settings),
      metrics_(metrics),
      epoll_(::epoll_create1(EPOLL_CLOEXEC)),
      wake_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  epoll_event event{.events = EPOLLIN, .data = {.ptr = nullptr}};
  if (!epoll_ || !wake_ || ::epoll_ctl(epoll_.get(), EPOLL_CTL_ADD, wake_.get(), &event) != 0) {
    throw std::system_error(errno, std::generic_category(), "cannot wait for clients");
  }
  thread_ = std::thread([this] { run(); });
}

void Delivery::send(Outgoing answer) {
  const Sent sent = send_some(answer, first_bytes);
  if (sent == Sent::failed) return;
  if (sent == Sent::all && finished(answer)) return;
  {
    const std::lock_guard lock(mutex_);
    inbox_.push_back(std::move(answer));
  }
  ::eventfd_write(wake_.get(), 1);
}

void Delivery::stop() {
  stopping_ = true;
  ::eventfd_write(wake_.get(), 1);
  if (thread_.joinable()) thread_.join();
}

/// Says that no more will come; true if nothing is to be waited for.
bool Delivery::finished(Outgoing& answer) const {
  ::shutdown(answer.socket.get(), SHUT_WR);
  return !answer.unread_input;
}

/// As send(2).
ssize_t Delivery::send_part(Outgoing& answer, std::size_t limit) {
  const int fd = answer.socket.get();
  if (answer.sent < answer.text.size()) {
    const std::size_t size = std::min(limit, answer.text.size() - answer.sent);
    // The file's first bytes can then go with the head.
    const int more = answer.file && answer.file->length > 0 ? MSG_MORE : 0;
    const ssize_t n =
        ::send(fd, answer.text.data() + answer.sent, size, MSG_DONTWAIT | MSG_NOSIGNAL | more);
    if (n > 0) answer.sent += static_cast<std::size_t>(n);
    return n;
  }
  off_t offset = answer.file->offset;
  const auto size = std::min(limit, static_cast<std::size_t>(answer.file->length));
  const ssize_t n = ::sendfile(fd, answer.file->file.get(), &offset, size);
  if (n > 0) {
    answer.file->offset += n;
    answer.file->length -= n;
  }
  return n;
}

Delivery::Sent Delivery::send_some(Outgoing& answer, std::size_t limit) {
  for (;;) {
    if (left(answer) == 0) return Sent::all;
    if (limit == 0) return Sent::more;
    const ssize_t n = send_part(answer, limit);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0 && errno == EAGAIN) return Sent::more;
    if (n <= 0) return Sent::failed;  // also: the file has become shorter
    limit -= static_cast<std::size_t>(n);
    metrics_.bytes_out += static_cast<std::uint64_t>(n);
  }
}

void Delivery::run() {
  std::array<epoll_event, 64> events;
  auto next_tick = PacedDeadline::Clock::now();
  while (!stopping_) {
    const bool idle = sending_.empty() && lingering_.empty();
    const int n = ::epoll_wait(epoll_.get(), events.data(), static_cast<int>(events.size()),
                               idle ? -1 : tick_milliseconds);
    for (int i = 0; i < n; ++i) {
      // An item has one event a round, and until all are looked at only that one can end it.
      if (auto* item = static_cast<Item*>(events.at(static_cast<std::size_t>(i)).data.ptr)) {
        item->in == &sending_ ? serve(*item) : linger(*item);
      }
    }
    take_in();
    if (const auto now = PacedDeadline::Clock::now(); now >= next_tick) {
      expire();
      next_tick = now + std::chrono::milliseconds(tick_milliseconds);
    }
    metrics_.delivering = sending_.size();
  }
  sending_.clear();
  lingering_.clear();
  metrics_.delivering = 0;
}

void Delivery::take_in() {
  std::vector<Outgoing> fresh;
  {
    const std::lock_guard lock(mutex_);
    std::swap(fresh, inbox_);
  }
  eventfd_t count = 0;
  ::eventfd_read(wake_.get(), &count);
  for (Outgoing& answer : fresh) add(std::move(answer));
  make_room();
}

void Delivery::add(Outgoing answer) {
  bytes_ += answer.text.size();
  sending_.push_back({std::move(answer),
                      PacedDeadline(settings_.answer_time, settings_.answer_bytes),
                      &sending_,
                      {}});
  Item& item = sending_.back();
  item.self = std::prev(sending_.end());
  epoll_event event{.events = EPOLLOUT, .data = {.ptr = &item}};
  if (::epoll_ctl(epoll_.get(), EPOLL_CTL_ADD, item.answer.socket.get(), &event) != 0) {
    drop(item, true);
  } else if (left(item.answer) == 0) {
    begin_to_linger(item);
  }
}

void Delivery::serve(Item& item) {
  const std::uint64_t before = left(item.answer);
  const Sent sent = send_some(item.answer, turn_bytes);
  if (sent == Sent::failed) return drop(item, false);
  if (sent == Sent::more) {
    item.deadline.count(before - left(item.answer));
    return sending_.splice(sending_.end(), sending_, item.self);
  }
  finished(item.answer) ? drop(item, false) : begin_to_linger(item);
}

void Delivery::begin_to_linger(Item& item) {
  bytes_ -= item.answer.text.size();
  item.answer.text = {};
  item.answer.sent = 0;
  item.answer.file.reset();
  item.deadline = PacedDeadline(linger_time);
  item.in = &lingering_;
  lingering_.splice(lingering_.end(), sending_, item.self);
  epoll_event event{.events = EPOLLIN, .data = {.ptr = &item}};
  ::epoll_ctl(epoll_.get(), EPOLL_CTL_MOD, item.answer.socket.get(), &event);
}

void Delivery::linger(Item& item) {
  std::array<char, 64 * 1024> buffer;
  const ssize_t n = ::recv(item.answer.socket.get(), buffer.data(), buffer.size(), MSG_DONTWAIT);
  if (n == 0 || (n < 0 && errno != EAGAIN && errno != EINTR)) drop(item, false);
}

void Delivery::expire() {
  for (Items* items : {&sending_, &lingering_}) {
    for (auto it = items->begin(); it != items->end();) {
      Item& item = *it++;
      if (item.deadline.over()) drop(item, items == &sending_);
    }
  }
}

/// Who has taken nothing for longest goes first: clients that merely have a thin line stay.
void Delivery::make_room() {
  while (sending_.size() > settings_.delivering) drop(sending_.front(), true);
  const auto is_in_memory = [](const Item& item) { return !item.answer.file; };
  while (bytes_ > settings_.delivering_bytes) {
    const auto first = std::find_if(sending_.begin(), sending_.end(), is_in_memory);
    if (first == sending_.end()) break;
    drop(*first, true);
  }
  while (lingering_.size() > settings_.delivering) drop(lingering_.front(), false);
}

void Delivery::drop(Item& item, bool given_up) {
  if (given_up) ++metrics_.given_up;
  bytes_ -= item.answer.text.size();
  // Closing takes it off epoll only where no child that is being started has the socket, too.
  ::epoll_ctl(epoll_.get(), EPOLL_CTL_DEL, item.answer.socket.get(), nullptr);
  item.in->erase(item.self);
}

}  // namespace lacuna
