"""What the command prints: the list of all entries, and what one found; as text and as values for JSON."""

import dataclasses
import math
import textwrap

from harness.run import KINDS
from harness.verdict import NOT_MEASURED, Claim

WIDTH = 118
HEADS = ("PAPER", "PUBLISHED [95 %]", "VERDICT", "OURS [95 %]", "VERDICT")


def table_text(columns, rows):
    """Columns as wide as they need, the first to the left."""
    def cell(value):
        return f"{value:.4g}" if isinstance(value, float) else str(value)

    texts = [[cell(value) for value in row] for row in (columns, *rows)]
    widths = [max(map(len, column)) for column in zip(*texts)]
    return "\n".join("  ".join(t.rjust(w) if i else t.ljust(w) for i, (t, w) in enumerate(zip(row, widths))).rstrip()
                     for row in texts)


def state(entry):
    return "built" if entry.built else "not built yet"


def list_text(entries):
    lines = []
    for e in entries:
        lines.append(f"{e.name:<18} {state(e):<14} {e.source}")
        told = f"{e.text} [{e.needs}]" + (f": {e.figures()}" if e.claims and e.figures() else "")
        lines += textwrap.wrap(told, WIDTH, initial_indent=" " * 19, subsequent_indent=" " * 19)
    return "\n".join(lines)


def list_json(entries):
    return [{"name": e.name, "built": e.built, "source": e.source, "text": e.text, "needs": e.needs,
             "claims": [claim_json(c) for c in e.claims]} for e in entries]


def row_cells(row):
    """The cells of a row below HEADS: the paper's figure, and both numbers with their verdicts. A number that there is
    not has no verdict beside one that there is."""
    cells = [str(row.claim)]
    for which in KINDS:
        number = getattr(row, which)
        cells += ["" if number is None else str(number), row.verdict(which) if which in row.measured() else ""]
    return cells


def run_text(run):
    parts = [f"{run.entry.name} ({run.version}): {run.entry.text}\n{run.entry.source}"]
    if run.rows:
        parts.append(table_text(("QUANTITY", *HEADS), [(r.claim.quantity, *row_cells(r)) for r in run.rows]))
    parts += [table_text(t.columns, t.rows) for t in run.tables]
    parts.append("\n".join(f"note: {n}" for n in (*run.notes, *general_notes(run))))
    return "\n\n".join(parts)


def general_notes(run):
    """What holds of every reproduction."""
    notes = []
    missing = sum(r.published is None and r.ours is None for r in run.rows)
    if missing:
        notes.append(f"{missing} of {len(run.rows)} {NOT_MEASURED}")
    numbers = [getattr(r, which) for r in run.rows for which in KINDS]
    if any(n is not None and not n.supported for n in numbers):
        notes.append("(in parentheses: the reference's own noise is too large to tell)")
    return notes


def run_json(run):
    return {"name": run.entry.name, "version": run.version, "source": run.entry.source, "text": run.entry.text,
            "seconds": run.seconds, "complete": run.complete, "rows": [row_json(r) for r in run.rows],
            "tables": [dataclasses.asdict(t) for t in run.tables], "notes": run.notes,
            "general_notes": general_notes(run),
            "pictures": [dataclasses.asdict(p) for p in run.shown], "commit": run.commit, "code": run.code}


def row_json(row):
    value = {"claim": claim_json(row.claim)}
    for which in KINDS:
        value[which] = {"value": value_json(getattr(row, which)), "ratio": value_json(row.ratio(which)),
                        "verdict": row.verdict(which) if which in row.measured() and row.claim.judged else None}
    return value


def claim_json(claim):
    """JSON has no infinity: a bound that is not there is null."""
    return {key: None if value in (math.inf, -math.inf) else value for key, value in dataclasses.asdict(claim).items()}


def claim_of(value):
    """The claim that claim_json() wrote."""
    bounds = {"low": -math.inf, "high": math.inf}
    return Claim(**{key: bounds.get(key) if v is None and key in bounds else v for key, v in value.items()})


def value_json(measured):
    return None if measured is None else dataclasses.asdict(measured)
