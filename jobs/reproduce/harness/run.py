"""One reproduction in the making: what an entry measures with, and what it found."""

import dataclasses
import json
import time

from harness import child, code, identity
from harness.measured import CONFIDENCE
from harness.verdict import MISSED, beside, verdict


@dataclasses.dataclass(frozen=True)
class Row:
    """A claim and two numbers of this project: that of the method with the settings as published, and that with this
    project's own. None: not measured."""

    claim: object
    published: object = None
    ours: object = None

    def verdict(self, which):
        """Of "published" or "ours"."""
        return verdict(self.claim, getattr(self, which))

    def ratio(self, which):
        """It over the paper's figure; None where there is no figure, or it is 0."""
        number = getattr(self, which)
        return number.scaled(1 / self.claim.figure) if number is not None and self.claim.figure else None

    def measured(self):
        """Which of the two there are; both names where there is none."""
        return [w for w in KINDS if getattr(self, w) is not None] or list(KINDS)


KINDS = ("published", "ours")
AS = {"published": {"as": "published"}, "ours": {}}  # of a job or a method: whose values its other settings have


@dataclasses.dataclass(frozen=True)
class Picture:
    """A picture's file, and of an EXR the layer that is shown."""

    caption: str
    file: str
    layer: str = ""


@dataclasses.dataclass(frozen=True)
class Table:
    """More than fits beside the paper's figures: columns, and rows of numbers and texts."""

    columns: tuple
    rows: list


class Run:
    """What `entry` measures with. `full`: as the paper did, as far as this machine allows, instead of in
    minutes. `folder` holds results from one start to the next, `runs` the results of the last sweep's jobs.

    A result lies in a folder whose name ends with a key of the job, the programs and the files that the job names
    (identity.py): another job, build or scene has a folder of its own, and an unfinished one goes on."""

    def __init__(self, entry, full, out):
        self.entry, self.full, self.folder = entry, full, out / entry.name
        self.tables, self.notes, self.complete = [], [child.machine()], True
        self.shown = []  # the Pictures for the page
        self.commit = identity.commit()
        self.code = {}  # code.of() the entry, once it is measured
        self.inputs = {}  # the hash of every scene and reference that was used
        self.seconds = 0.0
        self._rows = {claim.quantity: Row(claim) for claim in entry.claims}
        self._places = {}

    @property
    def version(self):
        return "full" if self.full else "quick"

    @property
    def rows(self):
        return list(self._rows.values())

    @property
    def missed(self):
        return any(row.verdict(which) == MISSED for row in self.rows for which in KINDS)

    def measure(self):
        """Calls the entry's function and takes its time, what is rendered already not included."""
        start = time.monotonic()
        self.code = code.of(self.entry)
        self.entry.measure(self)
        self.seconds = time.monotonic() - start

    def found(self, quantity, ours=None, published=None):
        """Our numbers (a Measured, or None) of a quantity that the catalogue has; KeyError otherwise. What is None stays
        as it is."""
        given = {which: value for which, value in (("ours", ours), ("published", published)) if value is not None}
        self._rows[quantity] = dataclasses.replace(self._rows[quantity], **given)

    def stands_beside(self, quantity, figure, ours, unit=""):
        """A number of ours beside one that is read from a file, such as a baseline's."""
        self._rows[quantity] = Row(beside(quantity, figure, unit), ours=ours)

    def note(self, text):
        self.notes.append(text)

    def show(self, caption, folder, layer=""):
        """Puts the picture of a result folder on the page, or one of its layers, in a row with the others of this entry."""
        self.shown.append(Picture(caption, str(folder / ("image.exr" if layer else "image.png")), layer))

    @property
    def pictures(self):
        """The folder below which render() leaves its results."""
        return self.folder / self.version

    def uses(self, value):
        """Records the scenes and references that a job, a sweep or a name speaks of; their hashes."""
        files = identity.files_named(value)
        self.inputs |= files
        return files

    def _keyed(self, name, value):
        """`name` with the key of what its result depends on."""
        return f"{name}-{identity.key(value, identity.programs(['lacuna']), self.uses(value))}"

    def render(self, name, job):
        """Renders a job into a folder of its own, once; gives its report. Throws Failed."""
        folder = self.pictures / self._keyed(name, job)
        self._places[name] = folder
        if _state(folder) != "done":
            folder.parent.mkdir(parents=True, exist_ok=True)
            file = folder.with_name(folder.name + ".json")
            file.write_text(json.dumps(job, indent=2) + "\n")
            child.lacuna("render", file, "--out", folder, "--quiet")
        return json.loads((folder / "report.json").read_text())

    def repeated(self, name, job, seeds):
        """The reports of the same job with the seeds 0, 1, ...; they are called NAME-SEED."""
        return [self.render(f"{name}-{seed}", {**job, "seed": seed}) for seed in range(seeds)]

    def place(self, name):
        """The folder of what render() has rendered by this name."""
        return self._places[name]

    def answers(self, sweep, shared=None):
        """Renders what is left of a sweep (the value of its file) and gives what `lacuna report --json` says of it. Its
        file and its folder lie in `folder`, so that the same command goes on where one was stopped, or in that of all
        entries that measure with the `shared` sweep. Throws Failed."""
        folder = self.folder.with_name(shared) if shared else self.folder
        folder.mkdir(parents=True, exist_ok=True)
        name = self._keyed(self.version, sweep)
        file, runs = folder / f"{name}.json", folder / f"{name}.sweep"
        self.runs = runs / "runs"
        file.write_text(json.dumps(sweep, indent=2) + "\n")
        exit_code = child.lacuna("sweep", file, "--out", runs, may_fail=True)[1]
        if exit_code not in (0, 1) or not runs.is_dir():  # 1: some runs failed; the report tells how many
            raise child.Failed(f"lacuna sweep ended with {exit_code}: {file}", exit_code)
        self.complete = self.complete and exit_code == 0
        answers = child.lacuna_json("report", runs)
        if answers["confidence"] != CONFIDENCE:
            raise child.Failed(f"intervals of {answers['confidence']} and of {CONFIDENCE} would be mixed")
        if empty := [cell["text"] or "the job" for cell in answers["cells"] if cell["done"] == 0]:
            raise child.Failed(f"no run is done of: {'; '.join(empty)} ({runs})")
        self.notes += answers["warnings"]
        return answers

    def run_folder(self, cell, seed=0):
        """That of one of the runs of a cell of the last answers."""
        return self.runs / cell["runs"][seed]["name"]

    def report(self, cell, seed=0):
        """The report of one of the runs of a cell of the last answers."""
        return json.loads((self.run_folder(cell, seed) / "report.json").read_text())


def _state(folder):
    """That of a job's folder, as "done"; None: there is none."""
    try:
        return json.loads((folder / "outcome.json").read_text())["state"]
    except (FileNotFoundError, KeyError, json.JSONDecodeError):
        return None


def cell_with(answers, **settings):
    """The cell of a sweep's answers in which the last parts of the swept pointers have these values; KeyError if there
    is none, or more than one."""
    found = [c for c in answers["cells"] if settings.items() <=
             {pointer.rsplit("/", 1)[1]: value for pointer, value in c["settings"].items()}.items()]
    if len(found) != 1:
        raise KeyError(f"{len(found)} cells have {settings}")
    return found[0]
