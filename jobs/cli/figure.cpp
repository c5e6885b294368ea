#include "jobs/figure/figure.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "base/storage/atomic_file.h"
#include "jobs/cli/commands.h"
#include "jobs/figure/suggest.h"
#include "jobs/spec/described_json.h"

namespace lacuna {
namespace {

struct FigureOptions {
  std::filesystem::path spec, suggest;
  std::vector<std::filesystem::path> out;
  bool ids = false;
};

std::string format_problem(const std::string& file) {
  const std::string ending = std::filesystem::path(file).extension().string();
  if (std::find(figure_formats.begin(), figure_formats.end(), ending) != figure_formats.end()) {
    return "";
  }
  return fmt::format("\"{}\" ends in none of {}", file, fmt::join(figure_formats, ", "));
}

/// Writes the file of a figure, by default to the terminal.
void suggest(const FigureOptions& o) {
  namespace fs = std::filesystem;
  const fs::path folder = o.out.empty() ? fs::path(".") : o.out.front().parent_path();
  const fs::path name = fs::relative(o.suggest, folder.empty() ? fs::path(".") : folder);
  const std::string text = write_document(suggest_figure(o.suggest, name.generic_string()));
  if (o.out.empty()) return fmt::print("{}", text);
  write_file_atomically(o.out.front(), text);
}

void figure(const FigureOptions& o) {
  if (!o.suggest.empty()) return suggest(o);
  const FigureSource source(parse_figure(read_file(o.spec, max_figure_bytes)),
                            o.ids ? std::nullopt : std::optional(o.spec.parent_path()));
  for (const std::string& warning : source.answers().warnings) {
    fmt::print(stderr, "warning: {}\n", warning);
  }
  for (const auto& file : o.out) {
    write_figure(source, file);
    fmt::print("{} ({:.1f} MB)\n", file.string(),
               static_cast<double>(std::filesystem::file_size(file)) / 1e6);
  }
}

}  // namespace

void add_figure(CLI::App& app, int& code) {
  const auto o = std::make_shared<FigureOptions>();
  CLI::App* command = app.add_subcommand(
      "figure", "Draw a sweep for a paper: pictures with crops, convergence, tables");
  CLI::Option* spec =
      command->add_option("SPEC", o->spec, "the figure's file (JSON)")->check(CLI::ExistingFile);
  CLI::Option* out =
      command->add_option("-o,--out", o->out,
                          "the figure, once or more: .pdf, .svg, .png, .tex (with its pieces in a "
                          "folder beside it), or its table: .csv, .md; with --suggest a .json");
  CLI::Option* suggested =
      command
          ->add_option("--suggest", o->suggest,
                       "print the file of a figure of this sweep, with the crops in which the "
                       "methods differ most")
          ->type_name("SWEEP")
          ->check(CLI::ExistingDirectory)
          ->excludes(spec);
  command->add_flag("--ids", o->ids,
                    "SPEC names its sweep or jobs by ids in the data folder, never by paths");
  command->callback([o, spec, out, suggested, &code] {
    if (spec->empty() && suggested->empty()) throw CLI::RequiredError("SPEC or --suggest");
    if (!spec->empty() && out->empty()) throw CLI::RequiredError("--out");
    for (const auto& file : o->out) {
      if (!suggested->empty()) break;
      if (const std::string problem = format_problem(file.string()); !problem.empty()) {
        throw CLI::ValidationError("--out", problem);
      }
    }
    figure(*o);
    code = exit_done;
  });
}

}  // namespace lacuna
