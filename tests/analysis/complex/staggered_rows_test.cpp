#include "base/parallel/staggered_rows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <stdexcept>
#include <vector>

namespace lacuna {
namespace {

/// Counts what was broken of the order: cells that began before those they follow were done.
class Order {
 public:
  explicit Order(int columns) : done_(static_cast<std::size_t>(columns)) {}

  void run(int row, int column) {
    const int last = static_cast<int>(done_.size()) - 1;
    if (of(column) != row) ++broken;  // each once, row after row
    if (column > 0 && of(column - 1) <= row) ++broken;
    if (column < last && of(column + 1) < row) ++broken;
    of(column) = row + 1;
    ++cells;
  }

  std::atomic<int> broken{0}, cells{0};

 private:
  std::atomic<int>& of(int column) { return done_[static_cast<std::size_t>(column)]; }
  std::vector<std::atomic<int>> done_;  // rows, by column
};

TEST(StaggeredRows, KeepTheirOrderAndAreAllRun) {
  for (const int threads : {0, 1, 2, 5}) {
    const ThreadPool pool(std::max(threads, 1));
    for (const int columns : {1, 2, 3, 9}) {
      Order order(columns);
      std::vector<int> asked;
      staggered_rows(
          threads == 0 ? nullptr : &pool, columns, [&](int r, int c) { order.run(r, c); },
          [&](int row) {
            asked.push_back(row);
            return row < 40;
          });
      EXPECT_EQ(order.broken, 0) << threads << " threads, " << columns << " columns";
      ASSERT_EQ(asked.size(), 41u);  // each complete row once, in order
      EXPECT_TRUE(std::is_sorted(asked.begin(), asked.end()));
      EXPECT_GE(order.cells, 41 * columns);
      EXPECT_LE(order.cells, 41 * columns + columns * columns / 2);
    }
  }
}

TEST(StaggeredRows, RethrowTheFirstException) {
  const ThreadPool pool(3);
  for (const ThreadPool* p : {static_cast<const ThreadPool*>(nullptr), &pool}) {
    EXPECT_THROW(staggered_rows(
                     p, 7,
                     [](int row, int column) {
                       if (row == 5 && column == 3) throw std::runtime_error("here");
                     },
                     [](int) { return true; }),
                 std::runtime_error);
  }
}

}  // namespace
}  // namespace lacuna
