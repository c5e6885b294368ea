#include "tests/extremes/matrix.h"

#include <fmt/format.h>

#include <algorithm>

namespace lacuna::extremes {
namespace {

std::string_view sign(const Verdict& v) {
  switch (v.kind) {
    case Verdict::Kind::ok:
      return "ok";
    case Verdict::Kind::refused:
      return "no";
    case Verdict::Kind::red:
      return "RED";
    case Verdict::Kind::left_out:
      return "-";
  }
  return "?";
}

/// The columns for which a row came to the same, and why: "3-7,9".
std::string ranges(const std::vector<std::size_t>& numbers) {
  std::string text;
  for (std::size_t i = 0; i < numbers.size();) {
    std::size_t end = i + 1;
    while (end < numbers.size() && numbers[end] == numbers[end - 1] + 1) ++end;
    text += (text.empty() ? "" : ",") + std::to_string(numbers[i]);
    if (end - i > 1) text += "-" + std::to_string(numbers[end - 1]);
    i = end;
  }
  return text;
}

}  // namespace

void Matrix::add_row(const std::string& name, std::vector<Verdict> verdicts) {
  rows_.push_back({name, std::move(verdicts)});
}

void Matrix::settle(double level) {
  for (const Line& row : rows_) {
    for (const Verdict& v : row.verdicts) tests_ += v.tests;
  }
  const double bar = statistics::sidak(level, std::max<std::size_t>(tests_, 1));
  for (Line& row : rows_) {
    for (Verdict& v : row.verdicts) {
      if (v.p >= bar || v.kind == Verdict::Kind::red) continue;
      v.kind = Verdict::Kind::red;
      v.why = fmt::format("{} (p = {:.2g}, below {:.2g})", v.doubtful, v.p, bar);
    }
  }
}

std::string Matrix::table(std::size_t first, std::size_t end) const {
  std::string text = fmt::format("{:<34}", "");
  for (std::size_t c = first; c < end; ++c) text += fmt::format("{:>4}", c + 1);
  for (const Line& row : rows_) {
    text += fmt::format("\n{:<34}", row.name);
    for (std::size_t c = first; c < end; ++c) text += fmt::format("{:>4}", sign(row.verdicts[c]));
  }
  return text + "\n\n";
}

std::string Matrix::remarks() const {
  std::string text;
  for (const Line& row : rows_) {
    std::vector<std::pair<const Verdict*, std::vector<std::size_t>>> groups;
    for (std::size_t c = 0; c < row.verdicts.size(); ++c) {
      const Verdict& v = row.verdicts[c];
      if (v.kind == Verdict::Kind::ok) continue;
      const auto same = std::find_if(groups.begin(), groups.end(), [&](const auto& g) {
        return g.first->kind == v.kind && g.first->why == v.why;
      });
      if (same != groups.end()) {
        same->second.push_back(c + 1);
      } else {
        groups.push_back({&v, {c + 1}});
      }
    }
    for (const auto& [v, numbers] : groups) {
      text += fmt::format("{:<4}{} [{}]: {}\n", sign(*v), row.name, ranges(numbers), v->why);
    }
  }
  return text;
}

std::string Matrix::text() const {
  constexpr std::size_t across = 21;  // in 120 columns
  std::string text;
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    text += fmt::format("{:>4}  {}\n", c + 1, columns_[c].name);
  }
  text += "\n";
  for (std::size_t c = 0; c < columns_.size(); c += across) {
    text += table(c, std::min(c + across, columns_.size()));
  }
  text += fmt::format(
      "ok: as required; no: refused, and rightly; -: does not apply; RED: neither. {} tests of "
      "means.\n\n",
      tests_);
  return text + remarks();
}

std::size_t Matrix::count(bool red) const {
  std::size_t n = 0;
  for (const Line& row : rows_) {
    for (const Verdict& v : row.verdicts) {
      n += v.kind != Verdict::Kind::left_out && (v.kind == Verdict::Kind::red) == red ? 1 : 0;
    }
  }
  return n;
}

std::size_t Matrix::passed() const { return count(false); }
std::size_t Matrix::failed() const { return count(true); }

}  // namespace lacuna::extremes
