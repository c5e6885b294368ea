#include "jobs/run/obstacle.h"

#include <atomic>
#include <cerrno>
#include <new>
#include <system_error>

#include "analysis/space/memory_limit.h"
#include "base/storage/passing_error.h"

namespace lacuna {
namespace {

std::atomic<bool> ran_out{false};

bool is_bad_alloc(const std::exception& e) {  // TBB's derive from it, too
  return dynamic_cast<const std::bad_alloc*>(&e) != nullptr;
}

}  // namespace

void watch_memory() {
  std::set_new_handler([] {
    ran_out = true;
    throw std::bad_alloc();
  });
}

Obstacle obstacle_of(const std::exception& e) {
  if (is_bad_alloc(e) || dynamic_cast<const MemoryLimitError*>(&e) != nullptr) {
    return Obstacle::memory;
  }
  if (const auto* error = dynamic_cast<const std::system_error*>(&e)) {
    const int number = error->code().value();
    if (number == ENOMEM) return Obstacle::memory;
    if (dynamic_cast<const InputUnreadable*>(&e) != nullptr) return Obstacle::input;
    if (may_pass(number)) return Obstacle::storage;
  }
  return ran_out ? Obstacle::memory : Obstacle::none;
}

std::string reason_of(const std::exception& e) {
  if (is_bad_alloc(e)) return "out of memory";
  return obstacle_of(e) == Obstacle::memory ? std::string("out of memory: ") + e.what() : e.what();
}

}  // namespace lacuna
