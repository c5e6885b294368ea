#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "renderer/race/noise.h"
#include "renderer/race/spread_gauge.h"
#include "renderer/race/trial.h"

namespace lacuna {

/// What a race may take, in the unit of costs: CPU seconds of each thread, or rays.
struct RaceLimits {
  double cost = std::numeric_limits<double>::infinity();
  int rounds = 12;
  /// What the whole picture may take, race included; 0: not known.
  double budget = 0;

  /// Of a budget of so many seconds a race takes at most 0.12 s^-0.4: a tenth of 2 s, a twentieth
  /// of 10 s, a two-hundredth of an hour.
  static RaceLimits of_seconds(double seconds);
};

/// How a method does, by what is known now.
struct Standing {
  double error = 0;    ///< expected mean squared error of a pixel times cost; 0: not known
  LogRatio over_best;  ///< log(error / error of the best)
  double growth = 1;   ///< the part of `error` that is foreseen from the tail (Trial::growth())
  double spread = 1;   ///< and from samples that are spread evenly (SpreadGauge)
  std::optional<bool> tail_known;  ///< none: too few iterations to say
  bool unexplained = false;  ///< `error` counts a difference to the others (unexplained_error())
  /// Of a biased method: the mean squared difference of a pixel to the unbiased ones, without
  /// noise, and its standard deviation.
  double bias = 0, bias_deviation = 0;
};

/// One line of the race's record.
struct RaceRow {
  std::int32_t round = 0;
  std::uint32_t entrant = 0;
  std::uint64_t iterations = 0;
  double cost = 0;
  double error = 0;  ///< as Standing's
  double log_ratio = 0, deviation = 0;
};

struct Entrant {
  Trial trial;
  bool racing = true;
  bool biased = false;      ///< its bias counts as error, and it shares the picture with no other
  bool beaten = false;      ///< left because of its error: comes back if the others prove worse
  std::string reason = {};  ///< why it left
  int left_in = -1;         ///< round
  bool shares_starts = false;         ///< shares_starts() of its settings
  bool spreads = false;               ///< its estimates are evenly spread samples, one by one
  std::optional<Spread> gauged = {};  ///< of its pictures, once there are enough
  BlockSums observed = {};            ///< of Race::observe(); empty: not yet
  Standing standing = {};
};

/// Finds the method with the least error for its cost, by rounds of growing length: one iteration
/// of each, then equal costs, doubled from round to round. A method leaves when it is known to be
/// worse than the best, and where it is not even the best in parts of the picture.
///
/// It does not render: next() names the entrant whose iteration is to be rendered next, and
/// finished(), failed() or leave() say what became of it. Given the same pictures and costs it
/// takes the same decisions.
class Race {
 public:
  Race() = default;
  /// `biased`: of each entrant; empty: none is.
  Race(std::size_t entrants, int width, int height, const RaceLimits& limits,
       const std::vector<std::uint8_t>& biased = {});

  /// Before the first iteration: what one of each entrant took for pictures with pixels `reduction`
  /// times as wide (BlockGrid), 0 for those that did not race. The race then has the largest
  /// pictures of which it can afford enough of each; an entrant whose pictures are too slow even so
  /// leaves.
  void choose_reduction(std::span<const double> costs, int reduction);
  /// Whether choose_reduction() has still to be called. Never with biased entrants: bias is told by
  /// whole pictures. Nor without a limit of costs.
  bool wants_smaller_pictures() const;
  int reduction() const { return reduction_; }
  const BlockGrid& grid() const { return grid_; }  ///< of whole pictures

  /// Nothing: the race is over.
  std::optional<std::size_t> next() const;
  /// The iteration that next() asked for.
  void finished(std::size_t entrant, const Image& estimate, double cost);
  /// `cost`: what the attempt took.
  void leave(std::size_t entrant, const std::string& reason, double cost = 0);

  /// After next() had nothing more: those that never began leave, and the others are judged.
  void close();
  /// What the entrant's estimates of the picture tell: their squared error in each block times the
  /// mean number `samples` of them. It counts in judge() in place of what its pictures in the race
  /// told, because spread samples err less the more they are, and not alike everywhere.
  void observe(std::size_t entrant, const BlockSums& variances, double samples);
  /// Judges all entrants that race by all that their trials hold, after more was added to them.
  void judge();

  std::vector<Entrant>& entrants() { return entrants_; }
  const std::vector<Entrant>& entrants() const { return entrants_; }
  const std::vector<RaceRow>& rows() const { return rows_; }
  double spent() const { return spent_; }
  int round() const { return round_; }
  const RaceLimits& limits() const { return limits_; }
  /// The racing entrant that is likely to have the least error for its cost; the first, where
  /// nothing is known.
  std::size_t best() const { return best_of(true); }
  /// Variances of one iteration, as far as they are known, growth and unexplained errors included.
  const std::vector<BlockSums>& variances() const { return variances_; }

  /// For checkpoints; load() into a race of the same entrants.
  void save(class ByteWriter& out) const;
  void load(class ByteReader& in);

 private:
  /// best(), of the unbiased alone where `biased` is false; entrants().size(): there is none.
  std::size_t best_of(bool biased) const;
  /// The entrant that tells the bias of the others; entrants().size(): no biased one races.
  std::size_t yardstick() const;
  bool in_this_round(const Entrant& e) const;
  std::size_t racing() const;
  /// Whether its variance is: of one estimate only where three or more tell it.
  bool is_known(std::size_t which) const;
  void end_round();
  void estimate_variances();
  /// The variance of whole pictures over that of smaller ones, where the race has them.
  double of_whole_pictures(std::size_t which) const;
  /// Spread::left_of() by the end of the budget.
  double foreseen_spread(std::size_t which) const;
  /// Of an entrant's error, by the end of the budget (Trial::growth()).
  double foreseen_growth(std::size_t which) const;
  /// The difference to the unbiased entrants that variances do not explain.
  BlockSums hidden_error(std::size_t which) const;
  /// Adds the bias to the variances, as large as it is for the rest of the budget.
  void count_bias(std::size_t which, const BlockSums& hidden);
  /// What is left of the budget for an entrant, in costs.
  double rest(const Trial& trial) const;
  /// The standing but for the comparison. `hidden`: unexplained_error(). `growth`: where few
  /// iterations show no tail, the largest of the others', because one scene's rare bright paths
  /// are rare for most methods.
  void judge_alone(std::size_t which, const BlockSums& hidden, double growth);
  void call_back(double growth);
  double log_cost_ratio(std::size_t a, std::size_t b) const;
  /// log(error a / error b) at equal cost.
  LogRatio ratio(std::size_t a, std::size_t b) const;
  /// The same, where few bright paths decide drawn towards the typical ratio of most blocks.
  double likely_ratio(std::size_t a, std::size_t b) const;
  /// The logarithm by which spread samples may err less than they seem to, while the gauge does not
  /// tell.
  double unknown_gain(std::size_t which) const;
  /// Whether another is surely better.
  bool is_beaten(std::size_t which) const;
  void drop_losers();

  RaceLimits limits_;
  BlockGrid grid_;
  std::vector<Entrant> entrants_;
  std::vector<BlockSums> measured_;   ///< variances of one iteration, as far as they are known
  std::vector<BlockSums> variances_;  ///< with growth and unexplained errors
  std::vector<SpreadGauge> gauges_;   ///< of each entrant, until the race is over
  std::vector<RaceRow> rows_;
  int reduction_ = 1;  ///< of its pictures
  double probed_ = 0;  ///< cost of what choose_reduction() was told
  double spent_ = 0;
  int round_ = 0;
  double slice_ = 0;  ///< what each entrant may have taken at the end of this round
};

}  // namespace lacuna
