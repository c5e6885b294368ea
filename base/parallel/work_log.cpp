#include "base/parallel/work_log.h"

#include <algorithm>

#include "base/parallel/clock_seconds.h"

namespace lacuna {

namespace {

constexpr std::size_t most_spans = std::size_t{1} << 20;

}  // namespace

WorkLog::WorkLog(int threads)
    : start_(clock_seconds(CLOCK_MONOTONIC)),
      threads_(static_cast<std::size_t>(threads)),
      spans_(static_cast<std::size_t>(threads)) {}

double WorkLog::now() const { return clock_seconds(CLOCK_MONOTONIC) - start_; }

void WorkLog::keep_spans() {
  keeps_ = true;
  marked_cpu_ = cpu_now();
}

double WorkLog::cpu_now() const { return keeps_ ? clock_seconds(CLOCK_THREAD_CPUTIME_ID) : 0; }

std::uint64_t WorkLog::lost_spans() const {
  std::uint64_t lost = 0;
  for (const Thread& t : threads_) lost += t.lost;
  return lost;
}

std::map<std::string, SectionTimes> WorkLog::sections() {
  if (is_owner() && !in_loop_) mark();
  std::map<std::string, SectionTimes> all;
  for (std::size_t i = 0; i < names_.size(); ++i) all[names_[i]] = times_[i];
  return all;
}

std::uint32_t WorkLog::enter(std::string_view name) {
  const std::uint32_t from = section_;
  if (!is_owner() || in_loop_) return from;
  mark();
  const auto found = std::ranges::find(names_, name);
  section_ = static_cast<std::uint32_t>(found - names_.begin());
  if (found == names_.end()) {
    names_.emplace_back(name);
    times_.emplace_back();
  }
  return from;
}

void WorkLog::leave(std::uint32_t to) {
  if (!is_owner() || in_loop_) return;
  mark();
  section_ = to;
}

void WorkLog::mark() {
  const double time = now();
  times_[section_].serial += time - marked_;
  const double cpu = cpu_now();
  keep(0, {marked_, time, cpu - marked_cpu_, section_, loop_, -1});
  marked_ = time;
  marked_cpu_ = cpu;
}

void WorkLog::keep(int thread, const Span& span) {
  if (!keeps_) return;
  std::vector<Span>& spans = spans_[static_cast<std::size_t>(thread)];
  if (spans.size() < most_spans) {
    spans.push_back(span);
  } else {
    ++threads_[static_cast<std::size_t>(thread)].lost;
  }
}

bool WorkLog::begin_loop() {
  if (!is_owner() || in_loop_) return false;
  mark();
  in_loop_ = true;
  for (Thread& t : threads_) {
    t.busy = 0;
    t.bodies = 0;
  }
  return true;
}

void WorkLog::end_loop() {
  const double time = now();
  SectionTimes& times = times_[section_];
  times.loops += time - marked_;
  for (const Thread& t : threads_) {
    times.busy += t.busy;
    times.bodies += t.bodies;
  }
  marked_ = time;
  marked_cpu_ = cpu_now();
  ++loop_;
  in_loop_ = false;
}

void WorkLog::run(int thread, int i, const std::function<void(int)>& body) {
  struct Timed {
    WorkLog& log;
    int thread, i;
    double begin = log.now(), cpu = log.cpu_now();
    ~Timed() {
      const double used = log.cpu_now() - cpu, end = log.now();
      Thread& own = log.threads_[static_cast<std::size_t>(thread)];
      own.busy += end - begin;
      ++own.bodies;
      log.keep(thread, {begin, end, used, log.section_, log.loop_, i});
    }
  };
  const Timed timed{*this, thread, i};
  body(i);
}

}  // namespace lacuna
