#include "jobs/run/choosing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "jobs/run/obstacle.h"
#include "jobs/run/ranking.h"
#include "jobs/spec/job_json.h"
#include "renderer/integrators/integrator.h"

namespace lacuna {

namespace {

bool is_timed(const Budget& budget) { return budget.seconds || budget.cpu_seconds; }

/// The budget of a candidate by the end of a turn: a `share` of all limits. Iterations come in
/// pairs, one for each half of the picture.
Budget part_of(const Budget& whole, double share) {
  Budget part;
  if (whole.seconds) part.seconds = *whole.seconds * share;
  if (whole.cpu_seconds) part.cpu_seconds = *whole.cpu_seconds * share;
  if (whole.iterations) {
    const std::int64_t pairs = std::llround(double(*whole.iterations) * share / 2);
    part.iterations = is_timed(whole)
                          ? *whole.iterations
                          : std::min(2 * std::max<std::int64_t>(pairs, 1), *whole.iterations);
  }
  if (!is_timed(whole) && !whole.iterations) part.seconds = Budget::default_seconds * share;
  return part;
}

/// The cost of a candidate's turns so far relative to the whole budget: in time or, for a budget of
/// iterations, in rays per iteration of the first candidate.
double part_spent(const Turn& turn, const Budget& whole, const Turn& first) {
  if (is_timed(whole)) return share(whole, {0, turn.seconds, turn.cpu_seconds});
  if (!whole.iterations) return turn.seconds / Budget::default_seconds;
  return turn.rays * double(first.iterations) / (first.rays * double(*whole.iterations));
}

}  // namespace

double share_of_turns(std::size_t candidates, int round) {
  double all = 0, slice = 0;
  for (double next = 1; candidates > 1; candidates = (candidates + 1) / 2) {
    all += double(candidates) * (next - slice);
    slice = std::exchange(next, 2 * next);
  }
  return all > 0 ? choosing_share / all * std::exp2(round) : 0;
}

/// A remaining candidate.
class Choosing::Entrant final : private Observer {
 public:
  Entrant(Choosing& all, std::size_t number, const Prepared& prepared)
      : k(number),
        spec(candidate_job(all.spec_, all.choice_.candidates[number])),
        folder(candidate_folder(all.folder_, all.choice_, number)),
        integrator(make_integrator(method_of(spec.integrator))),
        all_(all),
        task_{folder,         spec,        *prepared.scene,  *prepared.camera,
              *prepared.pool, *integrator, nullptr,          all.context_.interrupted,
              *this,          phases_,     prepared.content, all.context_.seconds_left} {
    analyse(prepared, *integrator);
  }

  Candidate& record() { return all_.choice_.candidates[k]; }
  RenderLoop& loop() {
    if (loop_ == nullptr) {
      open_folder();
      loop_ = std::make_unique<RenderLoop>(task_);
      loop_->resume();
    }
    return *loop_;
  }
  /// Frees its picture.
  void close() { loop_.reset(); }

  const std::size_t k;
  const JobSpec spec;
  const JobFolder folder;
  std::unique_ptr<Integrator> integrator;

 private:
  void open_folder() {
    const auto is_same = [&] { return write_job(folder.read_job()) == write_job(spec); };
    if (std::filesystem::exists(folder.file("job.json")) && is_same()) return;
    std::filesystem::remove_all(folder.dir());
    std::filesystem::create_directories(folder.dir().parent_path());
    JobFolder::create(folder.dir(), spec);
  }

  // Reported as progress of the job.
  void phase(const std::string&) override {}
  void progress(const Progress& own) override {
    Progress p = own;
    for (const Candidate& c : all_.choice_.candidates) {
      if (&c == &record() || c.turns.empty()) continue;
      p.seconds += c.turns.back().seconds;
      p.cpu_seconds += c.turns.back().cpu_seconds;
    }
    p.share = share(all_.spec_.budget, {std::uint64_t(own.iteration), p.seconds, p.cpu_seconds});
    p.remaining_seconds.reset();
    all_.folder_.write_progress(p);
    all_.context_.observer.progress(p);
  }
  void milestone(const std::string& line) override {
    all_.context_.observer.milestone(fmt::format("{}: {}", record().name, line));
  }
  void warning(const std::string& line) override {
    all_.context_.observer.warning(fmt::format("{}: {}", record().name, line));
  }

  Choosing& all_;
  PhaseSeconds phases_;
  RenderTask task_;
  std::unique_ptr<RenderLoop> loop_;
};

Choosing::Choosing(const JobFolder& folder, const JobSpec& spec, Choice choice,
                   const Prepared& prepared, const RunContext& context)
    : folder_(folder), spec_(spec), context_(context), choice_(std::move(choice)) {
  entrants_.resize(choice_.candidates.size());
  for (std::size_t k = 0; k < entrants_.size(); ++k) {
    Candidate& candidate = choice_.candidates[k];
    if (!candidate.left.empty()) continue;
    try {
      entrants_[k] = std::make_unique<Entrant>(*this, k, prepared);
    } catch (const Stopped&) {
      throw;
    } catch (const WaitInterrupted&) {
      throw;
    } catch (const std::exception& e) {
      leave_by_error(k, e);
    }
  }
  prepared.space->close();
}

Choosing::~Choosing() = default;

std::size_t Choosing::remaining() const {
  return std::size_t(std::count_if(entrants_.begin(), entrants_.end(),
                                   [](const auto& e) { return e != nullptr; }));
}

bool Choosing::run() {
  try {
    while (remaining() > 1) {
      std::size_t rounds = 0;
      for (const Candidate& c : choice_.candidates) rounds = std::max(rounds, c.turns.size());
      play(int(rounds));
      record();
    }
  } catch (const Stopped&) {
    return false;
  }
  const auto last =
      std::find_if(entrants_.begin(), entrants_.end(), [](const auto& e) { return e != nullptr; });
  choice_.chosen = int(last - entrants_.begin());
  record();
  context_.observer.milestone(fmt::format("chosen: {}", (*last)->record().name));
  return true;
}

void Choosing::record() {
  write_choice(folder_, choice_);
  for (std::size_t k = 0; k < entrants_.size(); ++k) {
    if (entrants_[k] != nullptr) continue;
    std::filesystem::remove(candidate_folder(folder_, choice_, k).file("checkpoint.bin"));
  }
}

void Choosing::play(int round) {
  const Budget part = part_of(spec_.budget, share_of_turns(choice_.candidates.size(), round));
  bool may_be_late = true;  // until one has finished an iteration
  for (auto& entrant : entrants_) {
    if (entrant != nullptr) take_turn(*entrant, part, may_be_late);
    if (entrant != nullptr) may_be_late = false;
  }
  judge();
}

void Choosing::take_turn(Entrant& entrant, const Budget& part, bool may_be_late) {
  try {
    RenderLoop& loop = entrant.loop();
    std::optional<Budget> limit;
    if (!may_be_late) limit = part_of(spec_.budget, first_iteration_share);
    const RenderLoop::End end = loop.run_part(part, limit);
    if (end == RenderLoop::End::interrupted) throw Stopped{};
    const Spent spent = loop.elapsed();
    const Counters& counters = loop.counters();
    Turn& turn = entrant.record().turns.emplace_back();
    turn.iterations = std::int64_t(spent.iterations);
    turn.seconds = spent.seconds;
    turn.cpu_seconds = spent.cpu_seconds;
    turn.rays = double(counters.rays + counters.shadow_rays);
    if (end == RenderLoop::End::no_iteration) {
      leave(entrant.k, "its first iteration takes too long for the budget");
    }
  } catch (const Stopped&) {
    throw;
  } catch (const std::exception& e) {
    leave_by_error(entrant.k, e);
  }
}

void Choosing::leave(std::size_t k, const std::string& why) {
  choice_.candidates[k].left = why;
  entrants_[k].reset();
}

void Choosing::leave_by_error(std::size_t k, const std::exception& e) {
  const Obstacle obstacle = obstacle_of(e);
  if (obstacle == Obstacle::storage || obstacle == Obstacle::input) throw;
  leave(k, reason_of(e));
  const bool is_last = std::all_of(choice_.candidates.begin(), choice_.candidates.end(),
                                   [](const Candidate& c) { return !c.left.empty(); });
  if (is_last) throw;
}

void Choosing::judge() {
  std::vector<CandidatePicture> pictures;
  std::vector<Entrant*> judged;
  for (const auto& e : entrants_) {
    if (e == nullptr) continue;
    judged.push_back(e.get());
    pictures.push_back({&e->loop().film(), biased(e->spec.integrator)});
  }
  const auto errors = picture_errors(pictures, choice_.metric);
  std::vector<std::optional<double>> expected;
  std::vector<bool> with_bias;
  const Turn first = judged.front()->record().turns.back();
  for (std::size_t i = 0; i < judged.size(); ++i) {
    Turn& turn = judged[i]->record().turns.back();
    if (errors[i]) {
      turn.noise = errors[i]->noise;
      turn.missing = errors[i]->missing;
      turn.bias = errors[i]->bias;
      turn.expected =
          turn.bias + turn.missing + *turn.noise * part_spent(turn, spec_.budget, first);
    } else if (const auto& before = judged[i]->record().turns; before.size() > 1) {
      // Keeps the estimate after one iteration, which compared it with other pictures.
      const Turn& last = before[before.size() - 2];
      turn.noise = last.noise, turn.missing = last.missing, turn.bias = last.bias;
      turn.expected = last.expected;
    }
    expected.push_back(turn.expected);
    with_bias.push_back(pictures[i].biased);
  }
  const std::vector<std::size_t> kept = better_half(expected, with_bias, judged.front()->k == 0);
  for (std::size_t i = 0; i < judged.size(); ++i) {
    if (std::find(kept.begin(), kept.end(), i) != kept.end()) continue;
    leave(judged[i]->k, expected[i] ? "not in the better half" : "its error is unknown");
  }
}

std::unique_ptr<Integrator> Choosing::take_integrator() {
  Entrant& chosen = *entrants_[std::size_t(*choice_.chosen)];
  chosen.close();
  return std::move(chosen.integrator);
}

}  // namespace lacuna
