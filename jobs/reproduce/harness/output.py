"""What the command prints: the list of all entries, and what one found; as text and as values for JSON."""

import dataclasses
import math
import textwrap

from harness.verdict import NOT_MEASURED

WIDTH = 118


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


def run_text(run):
    rows = [(r.claim.quantity, str(r.claim), "" if r.ours is None else str(r.ours),
             "" if r.ratio is None else str(r.ratio), r.verdict) for r in run.rows]
    parts = [f"{run.entry.name} ({run.version}): {run.entry.text}\n{run.entry.source}"]
    if rows:
        parts.append(table_text(("QUANTITY", "PAPER", "OURS [95 %]", "OURS / PAPER", "VERDICT"), rows))
    parts += [table_text(t.columns, t.rows) for t in run.tables]
    parts.append("\n".join(f"note: {n}" for n in (*run.notes, *general_notes(run))))
    return "\n\n".join(parts)


def general_notes(run):
    """What holds of every reproduction."""
    notes = []
    missing = sum(r.verdict == NOT_MEASURED for r in run.rows)
    if missing:
        notes.append(f"{missing} of {len(run.rows)} not measured")
    if any(r.ours is not None and not r.ours.supported for r in run.rows):
        notes.append("(in parentheses: the reference's own noise is too large to tell)")
    return notes


def run_json(run):
    return {"name": run.entry.name, "version": run.version, "source": run.entry.source, "text": run.entry.text,
            "rows": [{"claim": claim_json(r.claim), "ours": measured_json(r.ours), "ratio": measured_json(r.ratio),
                      "verdict": r.verdict or None} for r in run.rows],
            "tables": [dataclasses.asdict(t) for t in run.tables], "notes": [*run.notes, *general_notes(run)]}


def claim_json(claim):
    """JSON has no infinity: a bound that is not there is null."""
    return {key: None if value in (math.inf, -math.inf) else value for key, value in dataclasses.asdict(claim).items()}


def measured_json(measured):
    return None if measured is None else dataclasses.asdict(measured)
