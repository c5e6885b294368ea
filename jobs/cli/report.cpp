#include "jobs/report/report_html.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "base/storage/atomic_file.h"
#include "jobs/cli/commands.h"
#include "jobs/report/report_text.h"

namespace lacuna {
namespace {

struct ReportOptions {
  std::filesystem::path sweep, out;
  bool json = false, quiet = false;
};

void report(const ReportOptions& o) {
  const SweepFolder sweep(o.sweep);
  Answers answers = answer(sweep);
  const SweepPictures pictures = look_at_pictures(sweep, answers);
  for (std::size_t c = 0; c < answers.cells.size(); ++c) {
    answers.cells[c].bias_between_runs = pictures.bias_squared[c];
  }
  answers.warnings.insert(answers.warnings.end(), pictures.warnings.begin(),
                          pictures.warnings.end());
  if (o.json) return fmt::print("{}\n", answers_text(sweep, answers));
  const std::filesystem::path file = o.out.empty() ? sweep.dir() / "report.html" : o.out;
  write_file_atomically(file, report_html(sweep, answers, pictures));
  write_file_atomically(sweep.dir() / "table.csv", sweep_table(sweep));
  if (o.quiet) return;
  fmt::print("{}\n{}\n", report_text(sweep, answers), file.string());
}

}  // namespace

void add_report(CLI::App& app, int& code) {
  const auto o = std::make_shared<ReportOptions>();
  CLI::App* command = app.add_subcommand(
      "report", "Compare the runs of a sweep: report.html (one file) and table.csv in its folder");
  command->add_option("DIR", o->sweep, "a sweep's folder")
      ->required()
      ->check(CLI::ExistingDirectory);
  command->add_option("-o,--out", o->out, "the HTML file (default: DIR/report.html)");
  command->add_flag("--json", o->json, "print the answers as JSON and write no files");
  command->add_flag("-q,--quiet", o->quiet, "print nothing");
  command->callback([o, &code] {
    report(*o);
    code = exit_done;
  });
}

}  // namespace lacuna
