"""docs/reproduction.md: the table of every claim, and what each entry found."""

import pathlib
import re

from harness import child, code, everything, output, stored
from harness.run import KINDS
from harness.verdict import MISSED, NOT_TOLD_APART

PAGE = child.ROOT / "docs/reproduction.md"
PAPERS = (("noel", "Noel 2015"), ("nabata", "Nabata et al."), ("kol", "Kol et al. 2018"), ("popov", "Popov et al. 2015"),
          ("path", "Beside the papers"))
MOST_ROWS = 40  # of a table of an entry


def _escaped(text):
    """Of a cell of a table: Markdown takes these characters for its own."""
    for mark in ("\\", "|", "[", "]", "*", "_", "<"):
        text = text.replace(mark, "\\" + mark)
    return text


def _table(columns, lines):
    parts = ["| " + " | ".join(columns) + " |", "|" + " --- |" * len(columns)]
    parts += ["| " + " | ".join(map(_escaped, line)) + " |" for line in lines]
    return "\n".join(parts)


def _claims(outcomes):
    heads = ("entry", "quantity", "paper", "published", "verdict", "ours", "verdict")
    for prefix, title in PAPERS:
        lines = [(o.entry.name, row.claim.quantity, *everything.cells(row, reason))
                 for o in outcomes if o.entry.name.startswith(prefix) for row, reason in everything.rows(o)]
        if lines:
            yield f"## {title}\n\n{_table(heads, lines)}"


def _missed(outcomes):
    lines = []
    for o in outcomes:
        for row, _ in everything.rows(o) if o.run else ():
            whose = [which for which in KINDS if row.verdict(which) == MISSED]
            if whose:
                why = row.claim.why or "not known yet"
                lines.append(f"- `{o.entry.name}`, {row.claim.quantity} ({', '.join(whose)}): {why}")
    return "\n".join(lines) or "None."


def _found(outcome):
    run = outcome.run
    parts = [f"### {outcome.entry.name}", f"{outcome.entry.source}: {outcome.entry.text}. The {run.version} version took "
             f"{run.seconds:.0f} s at {run.commit}."]
    for table in run.tables:
        text = output.table_text(table.columns, table.rows[:MOST_ROWS])
        parts.append("\n".join(f"    {line}" for line in text.splitlines()))
    if run.shown:
        captions = "; ".join(_escaped(picture.caption) for picture in run.shown)
        together = stored.pictures(outcome.entry).relative_to(PAGE.parent)
        parts.append(f"![{outcome.entry.name}]({together})\n\nFrom the left, row by row: {captions}.")
    return "\n\n".join([*parts, "\n".join(f"- {_escaped(note)}" for note in (*run.notes, *output.general_notes(run)))])


SUMMARY = pathlib.Path(__file__).resolve().parents[1] / "summary.md"


def _summary(outcomes):
    """summary.md, whose {ENTRY | QUANTITY | WHICH} stand for numbers of ours, published or ours."""
    rows = {(o.entry.name, row.claim.quantity): row for o in outcomes for row, _ in everything.rows(o)}

    def number(mark):
        name, quantity, which = map(str.strip, mark[1].split("|"))
        found = getattr(rows[name, quantity], which)
        return "(not measured)" if found is None else f"{found.value:.3g}"

    return re.sub(r"\{([^{}]*)\}", number, SUMMARY.read_text()).strip()


STALE = "Measured with other code than that of the tree (`./dev reproduce --stale`): "


def _stale(outcomes):
    return STALE + (", ".join(f"`{run.entry.name}`" for run in stale(outcomes)) or "none") + "."


def stale(outcomes):
    """The runs whose code has changed since they were measured."""
    return [o.run for o in outcomes if o.run and code.changed(o.run)]


def text(outcomes):
    """The page of what the tree has (stored.py)."""
    found = everything.verdicts(outcomes)
    counts = ", ".join(f"{n} {verdict}" for verdict, n in found.items()) or "none"
    parts = [
        "# Reproduction",
        _summary(outcomes),
        "Written by `./dev reproduce --all --write` and `./dev reproduce NAME --write` from the results in `reproduction`; edits "
        "are lost. [The harness](../jobs/reproduce/README.md) explains the entries.",
        "`published`: the method with the settings that the paper names, on this project's code. `ours`: with this project's "
        "defaults and changes. Intervals hold the truth with a probability of 95 %. A verdict is `reached` where the whole "
        "interval bears the claim out, `missed` where none of it does, `not told apart` between the two, and `one run` where "
        "a number has no interval; figures without a bound are information.",
        f"Verdicts: {counts}; {everything.share(found, NOT_TOLD_APART):.0%} not told apart.",
        _stale(outcomes),
        *_claims(outcomes),
        "## Missed claims",
        _missed(outcomes),
        "## Measurements",
        *(_found(o) for o in outcomes if o.run)]
    return "\n\n".join(parts) + "\n"


def write(entries, runs):
    """Puts runs into the tree, and writes the page of all entries."""
    for run in runs:
        stored.write(run)
    PAGE.write_text(text(list(stored.outcomes(entries))))
