"""Faults in jobs: their files, the queue, sweeps, what is read off them."""

from fault import Fault

SPEC = ("test_spec",)
STORE = ("test_store",)
QUEUE = ("test_queue",)
SWEEP = ("test_sweep",)
RUN = ("test_run",)

FAULTS = [
    # The job file and its folder.
    Fault("K is a byte", "jobs/spec/byte_size.cpp",
          "static_cast<unsigned>(units.find(text.back()) + 1)", "static_cast<unsigned>(units.find(text.back()))", SPEC),
    Fault("large numbers of bytes overflow", "jobs/spec/byte_size.cpp",
          "if (count > most >> shift) refuse();", "if (count > most) refuse();", SPEC),
    Fault("two swapped letters are two edits", "jobs/spec/nearest.cpp",
          "before[j - 2] + 1", "before[j - 2] + 2", SPEC),
    Fault("the same budget is a larger one", "jobs/spec/budget_extension.cpp",
          "grows_ || !larger || *larger > *old;", "grows_ || !larger || *larger >= *old;", SPEC),
    Fault("lines of an error stay apart", "jobs/store/job_folder.cpp",
          "if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';", "if (c == 0x7f) c = ' ';", STORE),
    Fault("the first run of a sweep has its id", "jobs/store/job_ids.cpp",
          "(letters_value(sweep_id) + 1 + index)", "(letters_value(sweep_id) + index)", STORE),
    Fault("an input of the same size is unchanged", "jobs/store/inputs.cpp",
          "if (now.hash == before.hash && now.bytes == before.bytes)", "if (now.bytes == before.bytes)", STORE),
    Fault("a held job has no priority", "jobs/store/state.cpp",
          "return waits || s == State::held;", "return waits;", STORE),
    # The queue.
    Fault("no room on the disk stops no start", "jobs/queue/queue_runners.cpp",
          "if (exclusive_runs_ || disk_.is_low()) return std::nullopt;",
          "if (exclusive_runs_) return std::nullopt;", ("tests/server/requests.test.mjs",)),
    Fault("a crash more is allowed", "jobs/queue/exit_classification.cpp",
          "if (crashes < max_attempts)", "if (crashes <= max_attempts)", QUEUE),
    Fault("a job that is done keeps its error", "jobs/queue/exit_classification.cpp",
          "if (how != State::failed) state.error.clear();", "if (how == State::done) state.error.clear();", QUEUE),
    Fault("a page that cannot be read is a crash", "jobs/queue/exit_classification.cpp",
          "end.code == SIGXFSZ || end.code == SIGBUS", "end.code == SIGXFSZ", QUEUE),
    Fault("pages of the list overlap", "jobs/queue/store_queries.cpp",
          "page.next = std::to_string(page.jobs.back().number);",
          "page.next = std::to_string(page.jobs.back().number + 1);", QUEUE),
    Fault("the newest of equal priority is first", "jobs/queue/store_queries.cpp",
          "priority DESC, number LIMIT", "priority DESC, number DESC LIMIT", QUEUE),
    Fault("references are removed under their jobs", "jobs/queue/store_queries.cpp",
          " AND id NOT IN (SELECT reference FROM jobs WHERE reference != '') ORDER BY number", " ORDER BY number",
          ("test_server",)),
    Fault("words are searched for with their case", "jobs/queue/store_queries.cpp", '" lower(?))"', '" ?)"', QUEUE),
    Fault("a change of nothing is an event", "jobs/queue/store_change.cpp",
          "if (entry == *before) return;", "if (entry.id.empty()) return;", QUEUE),
    Fault("events of the future are known", "jobs/queue/journal.cpp",
          "number < 0 || number > last()", "number < 0", QUEUE),
    Fault("a disk is roomy as soon as it is not low", "jobs/queue/disk_watch.cpp",
          "was_low ? least + least / 10 : least", "was_low ? least : least", QUEUE),
    # Slurm.
    Fault("the last minute of a job is cut off", "jobs/slurm/request.cpp",
          "static_cast<int>(std::ceil(all / 60))", "static_cast<int>(all / 60)", QUEUE),
    Fault("a per cent in a path is a pattern", "jobs/slurm/request.cpp",
          "if (c == '%') pattern += c;", "if (c == '\\0') pattern += c;", QUEUE),
    # Runs.
    Fault("an iteration has two rows in the curve", "jobs/run/curve.cpp",
          "rows_.back().iteration == row.iteration", "rows_.back().seconds == row.seconds", RUN),
    Fault("the odd iteration is the first shard's", "jobs/run/iteration_set.cpp",
          "pairs % n == k ? 1 : 0", "k == 0 ? 1 : 0", RUN),
    # Sweeps and reports.
    Fault("the variance of a mean is biased", "jobs/sweep/estimate.cpp",
          "(v - m.mean) / (n - 1) / n", "(v - m.mean) / n / n", SWEEP),
    Fault("one run decides that a time is exact", "jobs/sweep/compare.cpp",
          "t.at_most |= crossing->at_most;", "t.at_most = crossing->at_most;", SWEEP),
    Fault("quotes in a table are not doubled", "jobs/sweep/table.cpp",
          """c == '"' ? "\\"\\"" : std::string(1, c)""", "std::string(1, c)", ("tests/jobs/cli/sweep.test.mjs",)),
    Fault("~0 and ~1 are exchanged", "jobs/sweep/pointer.cpp",
          "pointer[++i] == '1' ? '/' : '~'", "pointer[++i] == '1' ? '~' : '/'", SWEEP),
    Fault("part of a front at the noise is not said to be", "jobs/sweep/front.cpp",
          "last.at_floor |= next.at_floor;", "last.at_floor = next.at_floor;", SWEEP),
    Fault("products of pictures count those with themselves", "jobs/report/replicate_bias.cpp",
          "static_cast<double>(n_ * (n_ - 1))", "static_cast<double>(n_ * n_)", ("test_report",)),
    Fault("seeds of a figure's jobs are cells of their own", "jobs/figure/figure_cells.cpp",
          'std::to_array<std::string_view>({"label", "seed"})', 'std::to_array<std::string_view>({"label"})', ("test_figure",)),
    Fault("crops are where errors are largest", "jobs/report/crop_selection.cpp",
          "(errors_.size() > 1 ? (*low)[i] : 0)", "(errors_.size() > 1 ? 0 : 0 * (*low)[i])", ("test_report",)),
]
