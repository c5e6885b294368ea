"""Tables and figures of the papers beside ours: the paper's number, ours with its interval, their ratio, a verdict.

Without NAME: the list of all, and which are built. Exit codes: 0 nothing missed; 1 a claim is missed, a run failed, or
NAME is not built yet; 2 there is no NAME, or options that do not go together; 75 interrupted, and the same command continues;
else those of `lacuna`."""

import argparse
import json
import os
import pathlib
import sys

import catalogue
from harness import child, code, everything, kept, output, page, stored
from harness.run import Run


def arguments():
    parser = argparse.ArgumentParser(prog="./dev reproduce", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("name", nargs="?", metavar="NAME", help="a table or figure, as noel-table-1")
    parser.add_argument("--full", action="store_true", help="as long as it takes, instead of minutes")
    parser.add_argument("--all", action="store_true", help="every entry, and one table of all claims; what was measured "
                        "before with the same programs, scenes and entries is kept, so that it may be stopped")
    parser.add_argument("--kept", action="store_true", help="with --all: measures nothing, shows what was measured before")
    parser.add_argument("--stale", action="store_true", help="lists the results in the tree whose code has changed since; "
                        "with --write marks them on the page")
    parser.add_argument("--run", action="store_true", help="with --stale: measures each of them again, quick or full as it "
                        "was, and puts it into the tree")
    parser.add_argument("--write", action="store_true", help="puts what was found into docs/reproduction, and writes "
                        "docs/reproduction.md of all that is there")
    parser.add_argument("--json", action="store_true", help="prints JSON")
    parser.add_argument("--out", type=pathlib.Path, default=child.ROOT / "build/reproduce", metavar="DIR",
                        help="folder for the runs, one below it for each NAME (default: build/reproduce)")
    options = parser.parse_args()
    if options.all and options.name is not None:
        parser.error(f"--all and {options.name}: one of the two")
    if not options.all and options.kept:
        parser.error("--kept: with --all only")
    if options.stale and (options.all or options.full or options.name is not None):
        parser.error("--stale: without NAME, --all and --full")
    if options.run and not options.stale:
        parser.error("--run: with --stale only")
    if options.write and options.name is None and not (options.all or options.stale):
        parser.error("--write: with --all, --stale or NAME")
    return options


def show(options, text, value):
    print(json.dumps(value(), indent=2) if options.json else text())


def error(text):
    print(f"reproduce: {text}", file=sys.stderr)


def write(runs):
    """Puts runs into the tree; 0, or the exit code of what failed."""
    try:
        page.write(catalogue.ENTRIES, runs)
    except child.Failed as failed:
        error(failed)
        return failed.code
    return 0


def stale(options):
    """Lists the stale results; with --run measures them again. 0, or the exit code of the first that failed."""
    runs = page.stale(list(stored.outcomes(catalogue.ENTRIES)))
    if not options.run:
        rows = [(run.entry.name, run.version, run.commit, " and ".join(code.changed(run))) for run in runs]
        show(options, lambda: output.table_text(("ENTRY", "VERSION", "MEASURED AT", "CHANGED SINCE"), rows), lambda: rows)
        return write([]) if options.write else 0
    options.write = True
    for run in runs:
        options.full = run.full
        if (failed := reproduce(run.entry, options)) not in (0, 1):
            return failed
    return 0


def reproduce(entry, options):
    try:
        child.build(entry.targets)
        run = Run(entry, options.full, options.out.absolute())
        run.measure()
    except child.Failed as failed:
        error(failed)
        return failed.code
    kept.keep(run)
    if options.write and (failed := write([run])) != 0:
        return failed
    show(options, lambda: output.run_text(run), lambda: output.run_json(run))
    return 0 if run.complete and not run.missed else 1


def reproduce_all(options):
    """Every entry; where it is interrupted, the table of what is done by then."""
    outcomes, exit_code = [], 0
    try:
        if not options.kept:
            child.build(sorted({target for entry in catalogue.ENTRIES for target in entry.targets}))
        for outcome in everything.measure_all(catalogue.ENTRIES, options.full, options.out.absolute(), options.kept):
            outcomes.append(outcome)
    except (child.Failed, KeyboardInterrupt) as stopped:
        error(f"{stopped or 'interrupted'}; the same command continues")
        exit_code = stopped.code if isinstance(stopped, child.Failed) and stopped.code not in everything.STOPPED else 75
    if options.write:
        exit_code = write([o.run for o in outcomes if o.run is not None]) or exit_code
    show(options, lambda: everything.text(outcomes), lambda: everything.value(outcomes))
    if exit_code != 0:
        return exit_code
    built = [o for o in outcomes if o.entry.built]
    return 0 if all(o.run is not None and o.run.complete and not o.run.missed for o in built) else 1


def main():
    options = arguments()
    if options.all:
        return reproduce_all(options)
    if options.stale:
        return stale(options)
    if options.name is None:
        show(options, lambda: output.list_text(catalogue.ENTRIES), lambda: output.list_json(catalogue.ENTRIES))
        return 0
    entry = catalogue.find(options.name)
    if entry is None:
        error(f"there is no \"{options.name}\"; there are {', '.join(e.name for e in catalogue.ENTRIES)}")
        return 2
    if not entry.built:
        error(f"{entry.name} is not built yet; it needs {entry.needs}")
        return 1
    return reproduce(entry, options)


if __name__ == "__main__":
    try:
        sys.exit(main())
    except BrokenPipeError:  # whoever read it has seen enough
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
