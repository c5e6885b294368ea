#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <typeindex>
#include <vector>

#include "analysis/artefacts/codec.h"
#include "analysis/artefacts/key.h"
#include "analysis/artefacts/record.h"

namespace lacuna {

struct StoreSettings {
  std::filesystem::path folder;  ///< of the entries; made when needed; empty: no cache
  std::uint64_t byte_limit = 0;  ///< of all entries together
  double wait_seconds = 600;     ///< at most, for another process that makes the same
  std::string label;             ///< what people call the scene; stands in the entries
  std::function<void(const std::string&)> message;        ///< what is waited for; may be empty
  std::function<void(const std::string&)> warning;        ///< what went wrong; may be empty
  std::function<void(const std::string&)> building = {};  ///< told the type, before; may be empty
  std::function<bool()> interrupted;                      ///< true ends a wait; may be empty
};

/// Asked to stop while it waited for another process.
class WaitInterrupted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The artefacts of a scene: each is made at most once, whoever asks for it, and kept on disk for
/// the next job. Whatever is wrong with the cache (a damaged entry, a full disk, a process that
/// hangs) costs time only: it is reported, and the artefact is built. Safe to use from many
/// threads.
class ArtefactStore {
 public:
  explicit ArtefactStore(StoreSettings settings) : settings_(std::move(settings)) {}

  /// The artefact of `key`: the one that somebody in this process still holds, or its entry in the
  /// cache, or what `build` returns, which is then kept. `Codec<T>` says how. While another process
  /// or thread makes it, waits. Throws what `build` throws, and WaitInterrupted.
  template <class T>
  std::shared_ptr<const T> get(const ArtefactKey& key, const std::function<T()>& build);

  /// Notes that nobody asked for an artefact of this type.
  void not_needed(const std::string& type);
  /// What became of every request so far, in the order in which they ended.
  std::vector<ArtefactRecord> records() const;

 private:
  /// A request without its type.
  struct Request {
    std::type_index type;
    std::function<std::shared_ptr<const void>()> build;
    std::function<void(ArtefactWriter&, const void*)> encode;
    std::function<std::shared_ptr<const void>(ArtefactReader&)> decode;
  };
  /// What this process has of a key. `busy` is held by the thread that gets it.
  struct Slot {
    explicit Slot(std::type_index t) : type(t) {}
    const std::type_index type;
    std::mutex busy;
    std::weak_ptr<const void> value;
  };
  class Attempt;

  std::shared_ptr<const void> get_any(const ArtefactKey& key, const Request& request);
  Slot& slot_of(const ArtefactKey& key, std::type_index type);
  void warn(const std::string& line) const;
  void add(ArtefactRecord record);

  const StoreSettings settings_;
  mutable std::mutex mutex_;  // of what follows
  std::map<std::string, Slot> slots_;
  std::vector<ArtefactRecord> records_;
};

template <class T>
std::shared_ptr<const T> ArtefactStore::get(const ArtefactKey& key,
                                            const std::function<T()>& build) {
  const Request request{
      typeid(T), [&] { return std::make_shared<const T>(build()); },
      [](ArtefactWriter& out, const void* value) { encode(out, *static_cast<const T*>(value)); },
      [](ArtefactReader& in) { return std::make_shared<const T>(decode<T>(in)); }};
  return std::static_pointer_cast<const T>(get_any(key, request));
}

}  // namespace lacuna
