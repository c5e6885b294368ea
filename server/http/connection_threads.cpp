#include "server/http/connection_threads.h"

#include <pthread.h>

#include <chrono>
#include <cstring>
#include <exception>
#include <memory>
#include <thread>
#include <utility>

#include "base/log/log.h"

namespace lacuna {
namespace {

// The HTTP library matches a Range header by std::regex, which recurses per character: the 8 KiB of
// a header take 5 MiB.
constexpr std::size_t stack_bytes = 8 << 20;
constexpr std::chrono::milliseconds pause_without_thread{10};

}  // namespace

struct ConnectionThreads::Task {
  ConnectionThreads& threads;
  std::function<void()> serve;
};

ConnectionThreads::~ConnectionThreads() {
  std::unique_lock lock(mutex_);
  ended_.wait(lock, [this] { return count_ == 0; });
}

std::size_t ConnectionThreads::count() const {
  const std::lock_guard lock(mutex_);
  return count_;
}

void ConnectionThreads::start(std::function<void()> serve) {
  {
    std::unique_lock lock(mutex_);
    ended_.wait(lock, [this] { return count_ < most_; });
    ++count_;
  }
  pthread_attr_t attributes;  // std::thread cannot set a stack size
  ::pthread_attr_init(&attributes);
  ::pthread_attr_setdetachstate(&attributes, PTHREAD_CREATE_DETACHED);
  ::pthread_attr_setstacksize(&attributes, stack_bytes);
  auto task = std::unique_ptr<Task>(new Task{*this, std::move(serve)});
  pthread_t thread{};
  while (const int error = ::pthread_create(&thread, &attributes, run, task.get())) {
    log::warn("no thread for a connection: {}", std::strerror(error));
    std::this_thread::sleep_for(pause_without_thread);
  }
  task.release();  // owned by the thread
  ::pthread_attr_destroy(&attributes);
}

void* ConnectionThreads::run(void* pointer) {
  std::unique_ptr<Task> task(static_cast<Task*>(pointer));
  ConnectionThreads& threads = task->threads;
  try {
    task->serve();
  } catch (const std::exception& error) {
    log::error("a connection failed: {}", error.what());
  }
  task.reset();
  const std::lock_guard lock(threads.mutex_);
  --threads.count_;
  threads.ended_.notify_all();  // under the lock: `threads` may be destroyed once it is free
  return nullptr;
}

}  // namespace lacuna
