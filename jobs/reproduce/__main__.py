"""Tables and figures of the papers beside ours: the paper's number, ours with its interval, their ratio, a verdict.

Without NAME: the list of all, and which are built. Exit codes: 0 nothing missed; 1 a claim is missed, a run failed, or
NAME is not built yet; 2 there is no NAME; 75 interrupted, and the same command goes on; else those of `lacuna`."""

import argparse
import json
import os
import pathlib
import sys

import catalogue
from harness import child, output
from harness.run import Run
from harness.verdict import MISSED


def arguments():
    parser = argparse.ArgumentParser(prog="./dev reproduce", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("name", nargs="?", metavar="NAME", help="a table or figure, as noel-table-1")
    parser.add_argument("--full", action="store_true", help="as long as it takes, instead of minutes")
    parser.add_argument("--json", action="store_true", help="prints JSON")
    parser.add_argument("--out", type=pathlib.Path, default=child.ROOT / "build/reproduce", metavar="DIR",
                        help="folder for the runs, one below it for each NAME (default: build/reproduce)")
    return parser.parse_args()


def show(options, text, value):
    print(json.dumps(value(), indent=2) if options.json else text())


def error(text):
    print(f"reproduce: {text}", file=sys.stderr)


def reproduce(entry, options):
    try:
        child.build(entry.targets)
        run = Run(entry, options.full, options.out.absolute())
        entry.measure(run)
    except child.Failed as failed:
        error(failed)
        return failed.code
    show(options, lambda: output.run_text(run), lambda: output.run_json(run))
    return 0 if run.complete and all(row.verdict != MISSED for row in run.rows) else 1


def main():
    options = arguments()
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
