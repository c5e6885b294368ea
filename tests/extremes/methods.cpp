#include "tests/extremes/methods.h"

#include "tests/extremes/settings_changes.h"

namespace lacuna::extremes {
namespace {

/// The method with every change that the visitor knows, one at a time.
template <class Visitor, class... Args>
std::vector<Method> changed(const Method& method, Args... args) {
  std::vector<Method> all;
  for (int i = 0;; ++i) {
    Method next = method;
    Visitor visitor(i, args...);
    std::visit([&](auto& settings) { describe(visitor, settings); }, next.settings);
    if (visitor.made().empty()) return all;
    if (!conflict(next.settings).empty()) continue;
    next.name += visitor.made();
    all.push_back(std::move(next));
  }
}

/// Without roulette, which costs power: its own numbers have rows; with few lights, of which each
/// takes the time of all pixels.
template <class S>
S for_small_pictures(S settings) {
  if constexpr (std::is_same_v<S, ManyLightsSettings>) settings.light_paths = 100;
  // A guide sends some of them where they bring less than they would without.
  if constexpr (std::is_same_v<S, LightSettings>) settings.light_paths = 1000;
  if constexpr (std::is_same_v<S, MetropolisSettings>) {
    settings.chains = 64;
    settings.bootstrap = settings.mutations = 8;
  }
  if constexpr (requires { settings.roulette_depth; }) settings.roulette_depth = 8;
  return settings;
}

template <class... Ts>
std::vector<Method> registered(const std::variant<Ts...>&) {
  return {Method{std::string(Ts::name), for_small_pictures(Ts{})}...};
}

/// The integrators of the registry, and path tracing in a way that neither a choice nor a flag
/// makes.
std::vector<Method> integrators() {
  std::vector<Method> all = registered(IntegratorSettings{});
  PathSettings sharing = for_small_pictures(PathSettings{});
  sharing.reuse = 16;
  all.push_back({"path reuse=16", sharing});
  sharing.guide = SkeletonGuideSettings{};
  all.push_back({"path reuse=16 guide=skeleton", sharing});
  return all;
}

/// A visitor that finds the longest path, and changes it where `wanted` has a value.
struct Depth {
  std::optional<int> wanted = {}, found = {};
  template <class T>
  void operator()(std::string_view name, T& member, const Field&) {
    if constexpr (std::is_same_v<T, int>) {
      if (name != "max_depth") return;
      if (wanted) member = *wanted;
      found = member;
    }
  }
};

}  // namespace

std::vector<Method> methods(bool flags) {
  std::vector<Method> all;
  for (const Method& integrator : integrators()) {
    std::vector<Method> choices = changed<OtherChoice>(integrator);
    choices.insert(choices.begin(), integrator);
    for (const Method& choice : choices) {
      all.push_back(choice);
      if (!flags) continue;
      for (Method& flag : changed<OtherFlag>(choice)) all.push_back(std::move(flag));
    }
  }
  return all;
}

std::optional<int> max_depth(const Method& method) {
  if (biased(method.settings)) return std::nullopt;
  const auto* lights = std::get_if<ManyLightsSettings>(&method.settings);
  // Their variance has no bound: a mean shows nothing.
  if (lights != nullptr && lights->clamp == Clamp::off) return {};
  Depth visitor;
  IntegratorSettings settings = method.settings;
  std::visit([&](auto& s) { describe(visitor, s); }, settings);
  return visitor.found;
}

Method reference_for(const Method& method) {
  Method reference = registered(IntegratorSettings{}).front();
  Depth visitor{.wanted = max_depth(method)};
  std::visit([&](auto& s) { describe(visitor, s); }, reference.settings);
  return reference;
}

std::vector<Method> with_numbers_at(const Method& method, End end) {
  return changed<NumberAt>(method, end);
}

}  // namespace lacuna::extremes
