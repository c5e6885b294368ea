// Runs a fuzz target on files, without libFuzzer and its compiler: replay TARGET FILE...

#include <cstdio>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "tests/fuzz/target.h"

namespace lacuna::fuzz {
namespace {

std::map<std::string, RunInput>& targets() {
  static std::map<std::string, RunInput> all;
  return all;
}

}  // namespace

ReplayTarget::ReplayTarget(const char* name, RunInput run) { targets()[name] = run; }

int replay(const std::string& name, int count, char** files) {
  const auto target = targets().find(name);
  if (target == targets().end()) {
    std::fprintf(stderr, "replay: no target \"%s\"\n", name.c_str());
    return 2;
  }
  for (int i = 0; i < count; ++i) {
    std::printf("%s\n", files[i]);  // the last one is that of a crash
    std::fflush(stdout);
    std::ifstream in(files[i], std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(in), {}};
    if (!in.good() && !in.eof()) return 2;
    target->second(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  }
  return 0;
}

}  // namespace lacuna::fuzz

/// Mutators call it; nothing is mutated here.
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t*, std::size_t size, std::size_t) {
  return size;
}

int main(int count, char** words) {
  if (count < 2) return 2;
  return lacuna::fuzz::replay(words[1], count - 2, words + 2);
}
