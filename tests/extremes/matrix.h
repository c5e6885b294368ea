#pragma once

#include <string>
#include <vector>

#include "tests/extremes/check.h"

namespace lacuna::extremes {

/// Rows of extremes, columns of methods.
class Matrix {
 public:
  explicit Matrix(std::vector<Method> columns) : columns_(std::move(columns)) {}

  /// Verdicts in the order of the columns.
  void add_row(const std::string& name, std::vector<Verdict> verdicts);
  /// Once all rows are there: the tests' p-values become verdicts, so that all tests together raise
  /// a false alarm with probability `level` (Sidak 1967).
  void settle(double level);
  /// The matrix, what its letters mean, and a line for whatever is not plainly ok. At most 120
  /// columns wide.
  std::string text() const;
  /// Cells that are green, refusals among them; and red ones.
  std::size_t passed() const;
  std::size_t failed() const;

 private:
  struct Line {
    std::string name;
    std::vector<Verdict> verdicts;
  };
  std::size_t count(bool red) const;
  std::string table(std::size_t first, std::size_t end) const;
  std::string remarks() const;

  std::vector<Method> columns_;
  std::vector<Line> rows_;
  std::size_t tests_ = 0;
};

}  // namespace lacuna::extremes
