"""One reproduction in the making: what an entry measures with, and what it found."""

import dataclasses
import json
import os

from harness import child
from harness.measured import CONFIDENCE
from harness.verdict import beside, verdict


@dataclasses.dataclass(frozen=True)
class Row:
    """A claim and our number; None: not measured."""

    claim: object
    ours: object

    @property
    def verdict(self):
        return verdict(self.claim, self.ours)

    @property
    def ratio(self):
        """Ours over the paper's figure; None where there is no figure, or it is 0."""
        return self.ours.scaled(1 / self.claim.figure) if self.ours is not None and self.claim.figure else None


@dataclasses.dataclass(frozen=True)
class Table:
    """More than fits beside the paper's figures: columns, and rows of numbers and texts."""

    columns: tuple
    rows: list


class Run:
    """What `entry` measures with. `full`: as the paper did, as far as this machine allows, instead of in
    minutes. `folder` holds results from one start to the next, `runs` the results of the last sweep's jobs."""

    def __init__(self, entry, full, out):
        self.entry, self.full, self.folder = entry, full, out / entry.name
        self.tables, self.notes, self.complete = [], [child.machine()], True
        self._rows = {claim.quantity: Row(claim, None) for claim in entry.claims}

    @property
    def version(self):
        return "full" if self.full else "quick"

    @property
    def rows(self):
        return list(self._rows.values())

    def found(self, quantity, ours):
        """Our number (a Measured, or None) of a quantity that the catalogue has; KeyError otherwise."""
        self._rows[quantity] = Row(self._rows[quantity].claim, ours)

    def stands_beside(self, quantity, figure, ours, unit=""):
        """A number of ours beside one that is read from a file, such as a baseline's."""
        self._rows[quantity] = Row(beside(quantity, figure, unit), ours)

    def note(self, text):
        self.notes.append(text)

    def answers(self, sweep, shared=None):
        """Renders what is left of a sweep (the value of its file) and gives what `lacuna report --json` says of it. Its
        file and its folder lie in `folder`, so that the same command goes on where one was stopped, or in that of all
        entries that measure with the `shared` sweep. Throws Failed."""
        folder = self.folder.with_name(shared) if shared else self.folder
        folder.mkdir(parents=True, exist_ok=True)
        file, runs = folder / f"{self.version}.json", folder / f"{self.version}.sweep"
        self.runs = runs / "runs"
        fresh = file.with_suffix(".new")
        fresh.write_text(json.dumps(sweep, indent=2) + "\n")
        os.replace(fresh, file)
        code = child.lacuna("sweep", file, "--out", runs, may_fail=True)[1]
        if code not in (0, 1) or not runs.is_dir():  # 1: some runs failed; the report tells how many
            raise child.Failed(f"lacuna sweep ended with {code}: {file}", code)
        self.complete = code == 0
        answers = child.lacuna_json("report", runs)
        if answers["confidence"] != CONFIDENCE:
            raise child.Failed(f"intervals of {answers['confidence']} and of {CONFIDENCE} would be mixed")
        if empty := [cell["text"] or "the job" for cell in answers["cells"] if cell["done"] == 0]:
            raise child.Failed(f"no run is done of: {'; '.join(empty)} ({runs})")
        self.notes += answers["warnings"]
        return answers

    def report(self, cell, seed=0):
        """The report of one of the runs of a cell of the last answers."""
        return json.loads((self.runs / cell["runs"][seed]["name"] / "report.json").read_text())


def cell_with(answers, **settings):
    """The cell of a sweep's answers in which the last parts of the swept pointers have these values; KeyError if there
    is none, or more than one."""
    found = [c for c in answers["cells"] if settings.items() <=
             {pointer.rsplit("/", 1)[1]: value for pointer, value in c["settings"].items()}.items()]
    if len(found) != 1:
        raise KeyError(f"{len(found)} cells have {settings}")
    return found[0]
