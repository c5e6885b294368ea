// From one iteration to a million.
#include <fmt/format.h>

#include "tests/double_double.h"
#include "tests/extremes/rows.h"

namespace lacuna::extremes {
namespace {

Row once() {
  return {"one iteration", [](Stage& stage, const Method& method, Check& check) {
            const std::string& name = stage.scene("room", [] { return room({}); });
            JobSpec job = stage.job(method, name);
            job.budget.iterations = 1;
            const Picture a = stage.render(job);
            check.sound(a);
            for (const double v : a.film.variance_of_mean()) {
              check.require(v == 0, "one iteration has a variance");
            }
            check.require(
                !stage.plain(method).blocks.empty() && a.blocks[0] == stage.plain(method).blocks[0],
                "the first iteration depends on how many follow");
          }};
}

/// The film of one pixel against the same numbers in twice the precision.
Row many(std::int64_t iterations) {
  return {fmt::format("{} iterations", iterations),
          [=](Stage& stage, const Method& method, Check& check) {
            const std::string& name = stage.scene("room", [] { return room({}); });
            JobSpec job = stage.job(method, name);
            job.resolution = {1, 1};
            job.budget.iterations = iterations;
            Picture a;
            a.film = Film(1, 1);
            std::array<std::vector<double>, 3> values;
            a.counters = stage.iterate(job, [&](const Image& image) {
              a.film.add(a.film.iterations(), image);
              for (int c = 0; c < 3; ++c) {
                values[std::size_t(c)].push_back(double(image.pixels[0][c]));
              }
            });
            check.sound(a);
            for (std::size_t c = 0; c < 3; ++c) {
              const test::ExactMoments exact = test::exact_moments(values[c]);
              const double mean = a.film.mean()[c], variance = a.film.variance_of_mean()[c];
              check.require(std::abs(mean - exact.mean) <= exact.mean_bound,
                            fmt::format("the mean is {:.17g}, exactly {:.17g}", mean, exact.mean));
              check.require(std::abs(variance - exact.variance_of_mean) <= exact.variance_bound,
                            fmt::format("its variance is {:.17g}, exactly {:.17g}", variance,
                                        exact.variance_of_mean));
            }
          }};
}

}  // namespace

std::vector<Row> accumulation_rows(const Effort& effort) {
  return {once(), many(effort.quick ? 100 : 1'000'000)};
}

}  // namespace lacuna::extremes
