#include "server/routes/events.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <utility>

#include "server/http/message.h"
#include "server/routes/entry_json.h"
#include "server/settings/http_settings.h"

namespace lacuna {
namespace {

// Interval at which a waiting stream checks its client's connection.
constexpr std::chrono::milliseconds look_at_client{250};
constexpr std::chrono::seconds heartbeat{15};

/// Counts one open stream during its life.
class Seat {
 public:
  explicit Seat(std::shared_ptr<std::atomic<int>> taken) : taken_(std::move(taken)) {
    if (taken_->fetch_add(1) < max_event_streams) return;
    taken_->fetch_sub(1);
    throw HttpError(503,
                    fmt::format("{} event streams are open, which is the maximum: poll instead.",
                                max_event_streams))
        .with("Retry-After", "5");
  }
  Seat(const Seat&) = delete;
  Seat& operator=(const Seat&) = delete;
  ~Seat() { taken_->fetch_sub(1); }

 private:
  std::shared_ptr<std::atomic<int>> taken_;
};

/// Base of all streams: follows the journal, and sends heartbeats.
class Stream {
 public:
  Stream(Journal& journal, std::shared_ptr<std::atomic<int>> seats)
      : journal_(journal), seat_(std::move(seats)) {}
  virtual ~Stream() = default;

  std::optional<std::string> next() {
    if (over_) return std::nullopt;
    std::string text = std::exchange(begins_, false) ? begin() : follow();
    const auto now = std::chrono::steady_clock::now();
    if (text.empty() && now - said_ >= heartbeat) text = ":\n\n";
    if (!text.empty()) said_ = now;
    return text;
  }

 protected:
  /// The first texts; sets `seen_`.
  virtual std::string begin() = 0;
  virtual std::string text_of(const JobEvent& event) = 0;
  /// Called if events after `seen_` were discarded.
  virtual std::string forgotten() = 0;

  std::string format(std::string_view name, std::string_view data) const {
    return fmt::format("id: {}\nevent: {}\ndata: {}\n\n", journal_.name(seen_), name, data);
  }

  Journal& journal_;
  std::int64_t seen_ = 0;
  bool over_ = false;

 private:
  std::string follow() {
    const auto events = journal_.since(seen_, look_at_client);
    if (!events) return forgotten();
    std::string text;
    for (const JobEvent& event : *events) {
      seen_ = event.number;
      text += text_of(event);
      if (over_) break;
    }
    return text;
  }

  Seat seat_;
  std::chrono::steady_clock::time_point said_ = std::chrono::steady_clock::now();
  bool begins_ = true;
};

class JobStream final : public Stream {
 public:
  JobStream(Store& store, std::shared_ptr<std::atomic<int>> seats, std::string id,
            std::optional<std::int64_t> last)
      : Stream(store.journal(), std::move(seats)), store_(store), id_(std::move(id)), last_(last) {}

 private:
  std::string begin() override {
    if (!last_) return forgotten();
    seen_ = *last_;
    const auto missed = journal_.since(seen_, {});
    if (!missed) return forgotten();
    const bool news = std::any_of(missed->begin(), missed->end(),
                                  [&](const JobEvent& event) { return event.id == id_; });
    // Browsers reconnect to a stream that has ended, although they have all events.
    const auto entry = store_.find(id_);
    over_ = !news && (!entry || entry->over());
    return {};
  }

  std::string forgotten() override {
    seen_ = journal_.last();  // before the entry: changes in between are sent twice, not lost
    const auto entry = store_.find(id_);
    return entry ? tell(*entry) : end();
  }

  std::string text_of(const JobEvent& event) override {
    if (event.id != id_) return {};
    return event.entry ? tell(*event.entry) : end();
  }

  std::string tell(const JobEntry& entry) {
    std::string text;
    if (entry.progress) append(text, "progress", json_text(to_json(*entry.progress)), progress_);
    append(text, "state", json_text(state_json(entry)), state_);
    over_ = entry.over();
    return text;
  }

  std::string end() {
    over_ = true;
    return {};
  }

  void append(std::string& text, const char* name, std::string data, std::string& sent) const {
    if (data == sent) return;
    text += format(name, data);
    sent = std::move(data);
  }

  Store& store_;
  const std::string id_;
  const std::optional<std::int64_t> last_;
  std::string state_, progress_;
};

class AllStream final : public Stream {
 public:
  AllStream(Journal& journal, std::shared_ptr<std::atomic<int>> seats,
            std::optional<std::int64_t> last, bool reset)
      : Stream(journal, std::move(seats)), last_(last), reset_(reset) {}

 private:
  std::string begin() override {
    seen_ = last_.value_or(journal_.last());
    return reset_ ? format("reset", "{}") : std::string(":\n\n");
  }
  std::string forgotten() override {
    seen_ = journal_.last();
    return format("reset", "{}");
  }
  std::string text_of(const JobEvent& event) override {
    if (event.entry) return format("job", json_text(to_json(*event.entry)));
    return format("removed", json_text(OrderedJson{{"id", event.id}}));
  }

  const std::optional<std::int64_t> last_;
  const bool reset_;
};

}  // namespace

Events::Stream Events::job(const std::string& id, const std::optional<std::string>& last) {
  const auto seen = last ? store_.journal().number(*last) : std::nullopt;
  return [stream = std::make_shared<JobStream>(store_, open_, id, seen)] { return stream->next(); };
}

Events::Stream Events::all(const std::optional<std::string>& last) {
  const auto seen = last ? store_.journal().number(*last) : std::nullopt;
  return [stream = std::make_shared<AllStream>(store_.journal(), open_, seen, last && !seen)] {
    return stream->next();
  };
}

}  // namespace lacuna
