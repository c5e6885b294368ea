#include "jobs/run/candidates.h"

#include <fmt/format.h>

namespace lacuna {

namespace {

/// Path tracing with `reuse` of `pixels`, if these path lengths allow it.
PathSettings sharing(const PathLengths& lengths, int pixels) {
  PathSettings path{lengths};
  path.reuse = pixels;
  if (!path.conflict().empty()) path.reuse = 1;
  return path;
}

std::vector<CandidateSettings> by_default(const AutoSettings& settings) {
  PathSettings guided = sharing(settings, 64);
  guided.guide = LearnedSkeletonGuideSettings{};
  BdptSettings skeleton;
  skeleton.connections = SkeletonConnectionsSettings{};
  ManyLightsSettings lights;
  lights.visibility = ProbabilisticVisibilitySettings{};
  std::vector<CandidateSettings> all{guided, sharing(settings, 16), MetropolisSettings{}, skeleton,
                                     lights};
  if (settings.allow == Allow::unbiased) return all;
  all.insert(all.end(), {VcmSettings{}, SppmSettings{}});
  if (settings.allow == Allow::consistent) return all;
  ManyLightsSettings views;
  views.visibility = ViewMapsVisibilitySettings{};
  all.insert(all.end(), {PhotonMapSettings{}, views});
  return all;
}

/// Collects the names of strategies that are not the default, and `reuse`.
struct StrategyNames {
  std::string text;
  void operator()(std::string_view name, int& value, const Field&) {
    if (name == "reuse" && value > 1) text += fmt::format(", reuse {}", value);
  }
  template <class T>
  void operator()(std::string_view, T&, const Field&) {}
  template <class... Ts>
  void operator()(std::string_view, std::variant<Ts...>& choice, const Field&) {
    if (choice.index() == 0) return;
    std::visit([&](const auto& s) { text += fmt::format(", {}", s.name); }, choice);
  }
};

}  // namespace

std::vector<CandidateSettings> candidates(const AutoSettings& settings) {
  std::vector<CandidateSettings> all =
      settings.candidates.empty() ? by_default(settings) : settings.candidates;
  for (CandidateSettings& c : all) {
    std::visit([&](PathLengths& lengths) { lengths = settings; }, c);
  }
  return all;
}

std::string candidate_name(const CandidateSettings& settings) {
  CandidateSettings copy = settings;
  return std::visit(
      [](auto& s) {
        StrategyNames strategies{std::string(s.name)};
        describe(strategies, s);
        return strategies.text;
      },
      copy);
}

}  // namespace lacuna
