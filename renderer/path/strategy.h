#pragma once

#include <concepts>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "base/storage/bytes.h"
#include "renderer/path/contexts.h"

namespace lacuna {

/// The interface of every strategy: guides, connections and visibilities.
///
/// - needs_space(): whether prepare() uses the analysis of the empty space. Called before
/// prepare().
/// - prepare(): called once, before the first iteration. Its time is charged to the job's
///   preparation.
/// - save() and load(): the learned state, for checkpoints. It is the same bits for any number of
///   threads. load() follows prepare(), and throws std::runtime_error for the state of another
///   scene.
/// - statistics(): names and numbers for the report, of this process' iterations.
///
/// A strategy's settings say whether it is biased (`static constexpr bool biased`), because the
/// service reads them without linking the renderer.
template <class S>
concept Strategy = requires(S s, const S& k, const PrepareContext& context, ByteWriter& out,
                            ByteReader& in) {
  { k.needs_space() } -> std::same_as<bool>;
  s.prepare(context);
  k.save(out);
  s.load(in);
  { k.statistics() } -> std::same_as<std::vector<std::pair<std::string, double>>>;
};

/// Defaults for a strategy that needs, prepares, learns and counts nothing.
struct StrategyBase {
  static constexpr bool needs_space() { return false; }
  static void prepare(const PrepareContext&) {}
  static void save(ByteWriter&) {}
  static void load(ByteReader&) {}
  static std::vector<std::pair<std::string, double>> statistics() { return {}; }
};

/// A row of a registry: the settings that a job file names, and the class that implements them.
template <class SettingsOf, class StrategyOf>
struct Entry {
  using Settings = SettingsOf;
  using Strategy = StrategyOf;
};

/// The strategies of one kind, in the order of the variant of their settings.
template <class... Entries>
struct Registry {
  using Settings = std::variant<typename Entries::Settings...>;

  /// Calls `make.template operator()<Strategy>(settings)` for the alternative held by `settings`.
  template <class Make>
  static auto visit(const Settings& settings, Make&& make) {
    return std::visit(
        [&]<class S>(const S& s) { return make.template operator()<StrategyOf<S>>(s); }, settings);
  }

 private:
  template <class S, class First, class... Rest>
  static auto find() {
    if constexpr (std::is_same_v<S, typename First::Settings>) {
      return First{};
    } else {
      return find<S, Rest...>();
    }
  }
  template <class S>
  using StrategyOf = typename decltype(find<S, Entries...>())::Strategy;
};

}  // namespace lacuna
