#include "renderer/integrators/candidates.h"

namespace lacuna {

namespace {

/// Path tracing that shares light, where paths of these lengths may.
PathSettings path_tracing(const PathLengths& lengths) {
  PathSettings path{lengths};
  path.reuse = 16;
  if (!path.conflict().empty()) path.reuse = 1;
  return path;
}

std::vector<CandidateSettings> by_default(const AutoSettings& settings) {
  BdptSettings skeleton;
  skeleton.connections = SkeletonConnectionsSettings{};
  ManyLightsSettings lights;
  lights.visibility = ProbabilisticVisibilitySettings{};
  // In this order they begin: what is quick and wins most often comes first.
  std::vector<CandidateSettings> all{path_tracing(settings), MetropolisSettings{}, BdptSettings{},
                                     skeleton, lights};
  const Allow allow = settings.allow;
  if (allow == Allow::unbiased) return all;
  all.insert(all.end(), {VcmSettings{}, SppmSettings{}});
  if (allow == Allow::consistent) return all;
  ManyLightsSettings views;
  views.visibility = ViewMapsVisibilitySettings{};
  all.insert(all.end(), {PhotonMapSettings{}, views});
  return all;
}

/// Collects the names of strategies that are not the first of their kind, and how many pixels share
/// light.
struct StrategyNames {
  std::string text;
  void operator()(std::string_view name, int& value, const Field&) {
    if (name == "reuse" && value > 1) text += ", reuse " + std::to_string(value);
  }
  template <class T>
  void operator()(std::string_view, T&, const Field&) {}
  template <class... Ts>
  void operator()(std::string_view, std::variant<Ts...>& choice, const Field&) {
    if (choice.index() == 0) return;
    std::visit([&](const auto& s) { text += ", " + std::string(s.name); }, choice);
  }
};

}  // namespace

std::vector<IntegratorSettings> candidates(const AutoSettings& settings) {
  std::vector<IntegratorSettings> all;
  for (CandidateSettings c :
       settings.candidates.empty() ? by_default(settings) : settings.candidates) {
    std::visit(
        [&](auto& s) {
          static_cast<PathLengths&>(s) = settings;
          all.emplace_back(s);
        },
        c);
  }
  return all;
}

std::string candidate_name(const IntegratorSettings& settings) {
  IntegratorSettings copy = settings;
  return std::visit(
      [](auto& s) {
        StrategyNames strategies{std::string(s.name)};
        describe(strategies, s);
        return strategies.text;
      },
      copy);
}

}  // namespace lacuna
