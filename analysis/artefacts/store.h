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
  double wait_seconds = 600;     ///< longest wait for another process that builds the same artefact
  std::string label;             ///< readable name of the scene, stored in the entries
  std::function<void(const std::string&)> message;        ///< reports waits; may be empty
  std::function<void(const std::string&)> warning;        ///< reports problems; may be empty
  std::function<void(const std::string&)> building = {};  ///< called before builds; may be empty
  std::function<bool()> interrupted;  ///< true ends waits and packing; may be empty
};

/// StoreSettings::interrupted returned true during a wait for another process.
class WaitInterrupted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The artefacts of a scene: each is built at most once among all processes, and cached on disk for
/// the next job. A problem with the cache (a damaged entry, a full disk, a process that hangs)
/// costs time only: it is reported, and the artefact is built. Thread-safe.
class ArtefactStore {
 public:
  explicit ArtefactStore(StoreSettings settings) : settings_(std::move(settings)) {}

  /// The artefact of `key`: the object still in use in this process, or its cache entry, or the
  /// result of `build`, which is then cached by Codec<T>. Waits while another process or thread
  /// builds it. Throws the exceptions of `build`, WaitInterrupted and Stopped.
  template <class T>
  std::shared_ptr<const T> get(const ArtefactKey& key, const std::function<T()>& build);

  /// The same without building; null if the artefact is neither in use nor cached.
  template <class T>
  std::shared_ptr<const T> find(const ArtefactKey& key);

  /// Records that no artefact of this type was requested.
  void not_needed(const std::string& type);
  /// The outcomes of all requests so far, in the order in which they ended.
  std::vector<ArtefactRecord> records() const;

 private:
  /// A type-erased request. An empty `build`: only an existing artefact.
  struct Request {
    std::type_index type;
    std::function<std::shared_ptr<const void>()> build;
    std::function<void(ArtefactWriter&, const void*)> encode;
    std::function<std::shared_ptr<const void>(ArtefactReader&)> decode;
  };
  /// The artefact of a key in this process. `busy` is held by the thread that gets it.
  struct Slot {
    explicit Slot(std::type_index t) : type(t) {}
    const std::type_index type;
    std::mutex busy;
    std::weak_ptr<const void> value;
  };
  class Attempt;

  template <class T>
  static Request request(std::function<std::shared_ptr<const void>()> build);
  std::shared_ptr<const void> get_any(const ArtefactKey& key, const Request& request);
  Slot& slot_of(const ArtefactKey& key, std::type_index type);
  void warn(const std::string& line) const;
  void add(ArtefactRecord record);

  const StoreSettings settings_;
  mutable std::mutex mutex_;  // guards the members below
  std::map<std::string, Slot> slots_;
  std::vector<ArtefactRecord> records_;
};

template <class T>
ArtefactStore::Request ArtefactStore::request(std::function<std::shared_ptr<const void>()> build) {
  return {
      typeid(T), std::move(build),
      [](ArtefactWriter& out, const void* value) { encode(out, *static_cast<const T*>(value)); },
      [](ArtefactReader& in) { return std::make_shared<const T>(decode<T>(in)); }};
}

template <class T>
std::shared_ptr<const T> ArtefactStore::get(const ArtefactKey& key,
                                            const std::function<T()>& build) {
  return std::static_pointer_cast<const T>(
      get_any(key, request<T>([&] { return std::make_shared<const T>(build()); })));
}

template <class T>
std::shared_ptr<const T> ArtefactStore::find(const ArtefactKey& key) {
  return std::static_pointer_cast<const T>(get_any(key, request<T>({})));
}

}  // namespace lacuna
