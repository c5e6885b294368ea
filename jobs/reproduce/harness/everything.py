"""All entries in one go: what was measured before is kept, what is left is measured, and one table has every claim."""

import sys
import time

from harness import child, kept, output
from harness.kept import Outcome
from harness.run import KINDS, Row, Run

STOPPED = (75, 128 + 2, 128 + 15)  # exit codes of a program that was interrupted
COLUMNS = ("ENTRY", "QUANTITY", *output.HEADS)


def say(text):
    print(f"reproduce: {text}", file=sys.stderr, flush=True)


def measure_all(entries, full, out, only_kept=False):
    """Yields the Outcome of each entry, in their order. `only_kept`: measures nothing. Throws child.Failed with one of the
    codes STOPPED, or KeyboardInterrupt, where it is interrupted: what is done by then is kept."""
    for i, entry in enumerate(entries):
        place = f"{entry.name} ({i + 1} of {len(entries)})"
        if not entry.built:
            yield Outcome(entry, reason="not built yet")
            continue
        run = kept.load(entry, full, out)
        if run is not None:
            say(f"{place}: kept")
        elif only_kept:
            yield Outcome(entry, reason="not run")
            continue
        else:
            say(f"{place} ...")
            run = Run(entry, full, out)
            start = time.monotonic()
            try:
                run.measure()
            except child.Failed as failed:
                if failed.code in STOPPED:
                    raise
                say(f"{place}: {failed}")
                yield Outcome(entry, reason=f"failed: {failed}")
                continue
            kept.keep(run)
            say(f"{place}: {time.monotonic() - start:.0f} s")
        yield Outcome(entry, run)


def rows(outcome):
    """Of an entry, each claim as a Row and, of one that was not measured, why."""
    if outcome.run is not None:
        return [(row, "") for row in outcome.run.rows]
    return [(Row(claim), outcome.reason) for claim in outcome.entry.claims]


def cells(row, reason):
    """The cells below output.HEADS."""
    return [str(row.claim), "", reason, "", ""] if reason else output.row_cells(row)


def text(outcomes):
    """One table of every claim."""
    lines = [(o.entry.name, row.claim.quantity, *cells(row, reason)) for o in outcomes for row, reason in rows(o)]
    return output.table_text(COLUMNS, lines)


def value(outcomes):
    return [{"name": o.entry.name, "reason": o.reason or None, "run": o.run and output.run_json(o.run),
             "rows": [output.row_json(row) for row, _ in rows(o)]} for o in outcomes]


def share(found, verdict):
    """Of verdicts(), that of one; 0 of none."""
    return found.get(verdict, 0) / max(1, sum(found.values()))


def verdicts(outcomes):
    """How many rows have each verdict."""
    found = {}
    for o in outcomes:
        for row, _ in rows(o) if o.run else ():
            for which in KINDS if row.claim.judged else ():
                if getattr(row, which) is not None:
                    found[row.verdict(which)] = found.get(row.verdict(which), 0) + 1
    return dict(sorted(found.items()))
