#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace lacuna {

/// How parallel a section of the program was. Seconds of the wall clock.
struct SectionTimes {
  double serial = 0;         ///< outside of loops: one thread worked, all others waited
  double loops = 0;          ///< inside of loops
  double busy = 0;           ///< of all threads in the bodies of loops, added up
  std::uint64_t bodies = 0;  ///< of loops

  /// Of all threads in loops without a body to run: for others to end, or for a body to begin.
  double waiting(int threads) const { return threads * loops - busy; }
};

/// What the threads of a pool spent their time on, by section of the program. The thread that made
/// it enters sections and runs loops; loops of other threads, and loops within loops, are not
/// recorded.
class WorkLog {
 public:
  explicit WorkLog(int threads);

  /// A span of time of one thread.
  struct Span {
    double begin, end;      ///< seconds since the log was made
    double cpu;             ///< CPU seconds of the thread
    std::uint32_t section;  ///< index in names()
    std::uint32_t loop;     ///< number of the loop, or of the loop that follows
    std::int32_t body;      ///< index of the body in its loop; -1: outside of loops
  };
  /// From now on, spans are kept for spans(): the first 2^20 of each thread.
  void keep_spans();
  /// Of each thread, in the order of time.
  const std::vector<std::vector<Span>>& spans() const { return spans_; }
  /// Spans that were not kept because there were too many.
  std::uint64_t lost_spans() const;

  const std::vector<std::string>& names() const { return names_; }
  /// By name. Time outside of all sections is in "other".
  std::map<std::string, SectionTimes> sections();

  // By ThreadPool and WorkSection alone:

  /// Enters section `name`; returns the section that leave() returns to.
  std::uint32_t enter(std::string_view name);
  void leave(std::uint32_t to);
  /// Whether a loop that this thread is about to run is recorded.
  bool begin_loop();
  void end_loop();
  /// Body `i` of a recorded loop, on thread `thread` of the pool.
  void run(int thread, int i, const std::function<void(int)>& body);

 private:
  struct alignas(64) Thread {
    double busy = 0;  // in the present loop
    std::uint64_t bodies = 0, lost = 0;
  };

  double now() const;
  /// CPU seconds of the thread, if spans are kept: the clock is slow.
  double cpu_now() const;
  bool is_owner() const { return std::this_thread::get_id() == owner_; }
  /// Ends the serial time since the last mark.
  void mark();
  void keep(int thread, const Span& span);

  std::thread::id owner_ = std::this_thread::get_id();
  double start_;
  bool keeps_ = false;
  bool in_loop_ = false;
  std::uint32_t loop_ = 0;
  std::uint32_t section_ = 0;
  double marked_ = 0, marked_cpu_ = 0;
  std::vector<std::string> names_{"other"};
  std::vector<SectionTimes> times_{1};
  std::vector<Thread> threads_;
  std::vector<std::vector<Span>> spans_;
};

}  // namespace lacuna
