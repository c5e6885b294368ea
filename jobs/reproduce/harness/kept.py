"""What entries found, kept from one start to the next, so that all of them can be stopped and go on."""

import dataclasses
import json
import os
import pathlib
import sys

from harness import identity, output
from harness.measured import Measured
from harness.run import KINDS, Row, Run, Table


def _sources(entry):
    """The hashes of the Python that measures an entry."""
    module = pathlib.Path(sys.modules[entry.measure.__module__].__file__)
    harness = sorted(pathlib.Path(__file__).parent.glob("*.py"))
    return {file.name: identity.file_hash(file) for file in (module, *harness)}


def _key(entry, inputs):
    """Of what a result depends on: the programs, the Python that measures, and the scenes that were used."""
    now = {name: identity.scene_file(name) for name in inputs}
    return identity.key(identity.programs(entry.targets), _sources(entry),
                        {name: file and identity.file_hash(file) for name, file in now.items()})


def _file(run):
    return run.folder / f"{run.version}.result.json"


def keep(run):
    """Writes what a run found."""
    run.folder.mkdir(parents=True, exist_ok=True)
    value = {"key": _key(run.entry, run.inputs), "inputs": sorted(run.inputs), **output.run_json(run)}
    fresh = _file(run).with_suffix(".new")
    fresh.write_text(json.dumps(value, indent=1) + "\n")
    os.replace(fresh, _file(run))


def load(entry, full, out):
    """The run of an entry that was kept; None where there is none, or where the programs, the Python or the scenes are
    others now."""
    run = Run(entry, full, out)
    try:
        value = json.loads(_file(run).read_text())
        if value["key"] != _key(entry, value["inputs"]):
            return None
    except (FileNotFoundError, KeyError, json.JSONDecodeError):
        return None
    claims = {c.quantity: c for c in entry.claims}
    run._rows = {}
    for row in value["rows"]:
        claim = claims.get(row["claim"]["quantity"]) or output.claim_of(row["claim"])
        numbers = {which: row[which]["value"] and Measured(**row[which]["value"]) for which in KINDS}
        run._rows[claim.quantity] = Row(claim, **numbers)
    run.tables = [Table(tuple(t["columns"]), t["rows"]) for t in value["tables"]]
    run.notes = [n for n in value["notes"] if n not in output.general_notes(run)]
    run.seconds, run.complete = value["seconds"], value["complete"]
    return run


@dataclasses.dataclass(frozen=True)
class Outcome:
    """What became of an entry: its run, or the reason why there is none, as "not built yet"."""

    entry: object
    run: object = None
    reason: str = ""
