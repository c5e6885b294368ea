#include "server/events.h"

#include <fmt/format.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>
#include <utility>

#include "server/message.h"
#include "server/settings.h"

namespace lacuna {
namespace {

// Renderers write progress a few times a second: looking at two small files as often is simpler
// than a notice from the kernel, and costs next to nothing.
constexpr std::chrono::milliseconds look_again{250};
constexpr std::chrono::seconds heartbeat{15};

/// Counts one open stream for as long as it lives.
class Seat {
 public:
  explicit Seat(std::shared_ptr<std::atomic<int>> taken) : taken_(std::move(taken)) {
    if (taken_->fetch_add(1) < max_event_streams) return;
    taken_->fetch_sub(1);
    throw HttpError(503, fmt::format("{} streams of events are open, and there may be no more: "
                                     "poll the job instead.",
                                     max_event_streams))
        .with("Retry-After", "5");
  }
  Seat(const Seat&) = delete;
  Seat& operator=(const Seat&) = delete;
  ~Seat() { taken_->fetch_sub(1); }

 private:
  std::shared_ptr<std::atomic<int>> taken_;
};

/// One watcher of one job.
class Stream {
 public:
  Stream(const Queue& queue, JobFolder folder, std::shared_ptr<std::atomic<int>> seats)
      : queue_(queue), folder_(std::move(folder)), seat_(std::move(seats)) {}

  std::optional<std::string> next() {
    if (over_) return std::nullopt;
    if (!std::exchange(first_, false)) std::this_thread::sleep_for(look_again);
    std::string text;
    try {
      // In this order, the last progress is there before a terminal state, and that is final.
      const bool held = queue_.holds(folder_);
      const JobState state = queue_.state(folder_);
      if (const auto p = folder_.read_progress()) append(text, "progress", to_json(*p), progress_);
      append(text, "state", to_json(state), state_);
      over_ = !held && is_terminal(state.state);
    } catch (const std::runtime_error&) {  // the folder was removed
      return std::nullopt;
    }
    const auto now = std::chrono::steady_clock::now();
    if (text.empty() && now - last_ >= heartbeat) text = ":\n\n";
    if (!text.empty()) last_ = now;
    return text;
  }

 private:
  static void append(std::string& text, const char* name, const Json& json, std::string& last) {
    std::string data = json.dump(-1, ' ', false, Json::error_handler_t::replace);
    if (data == last) return;
    text += fmt::format("event: {}\ndata: {}\n\n", name, data);
    last = std::move(data);
  }

  const Queue& queue_;
  JobFolder folder_;
  Seat seat_;
  std::string state_, progress_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
  bool first_ = true, over_ = false;
};

}  // namespace

std::function<std::optional<std::string>()> Events::open(const JobFolder& folder) {
  return
      [stream = std::make_shared<Stream>(queue_, folder, open_streams_)] { return stream->next(); };
}

}  // namespace lacuna
