#pragma once

#include <cstddef>
#include <cstdint>

// A fuzz target and its mutator, each the body of a function. libFuzzer takes them by its own
// names, one target a program; `replay` holds all targets by theirs.

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace lacuna::fuzz {

using RunInput = int (*)(const std::uint8_t* data, std::size_t size);

/// Makes a target known to `replay`.
struct ReplayTarget {
  ReplayTarget(const char* name, RunInput run);
};

}  // namespace lacuna::fuzz

#ifdef LACUNA_REPLAY
#define LACUNA_FUZZ_TARGET(name)                                            \
  static int run_##name(const std::uint8_t*, std::size_t);                  \
  static const lacuna::fuzz::ReplayTarget replay_##name(#name, run_##name); \
  static int run_##name([[maybe_unused]] const std::uint8_t* data, std::size_t size)
#define LACUNA_FUZZ_MUTATOR(name)                    \
  [[maybe_unused]] static std::size_t mutate_##name( \
      std::uint8_t* data, std::size_t size, std::size_t max_size, [[maybe_unused]] unsigned seed)
#else
#define LACUNA_FUZZ_TARGET(name) \
  extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
#define LACUNA_FUZZ_MUTATOR(name)                 \
  extern "C" std::size_t LLVMFuzzerCustomMutator( \
      std::uint8_t* data, std::size_t size, std::size_t max_size, [[maybe_unused]] unsigned seed)
#endif
