"""What entries found, kept from one start to the next, so that all of them can be stopped and go on."""

import dataclasses
import json
import os

from harness import code, identity, output
from harness.measured import Measured
from harness.run import KINDS, Picture, Row, Run, Table


def _key(entry, inputs):
    """Of what a result depends on: the programs, the Python that measures, and the scenes that were used."""
    now = {name: identity.scene_file(name) for name in inputs}
    return identity.key(identity.programs(entry.targets), code.python(entry.measure),
                        {name: file and identity.file_hash(file) for name, file in now.items()})


def _file(run):
    return run.folder / f"{run.version}.result.json"


def write_json(file, value):
    """As a whole or not at all."""
    file.parent.mkdir(parents=True, exist_ok=True)
    fresh = file.with_suffix(".new")
    fresh.write_text(json.dumps(value, indent=1) + "\n")
    os.replace(fresh, file)


def keep(run):
    """Writes what a run found."""
    write_json(_file(run), {"key": _key(run.entry, run.inputs), "inputs": sorted(run.inputs), **output.run_json(run)})


def fill(run, value):
    """Gives `run` what output.run_json() wrote. A claim that the entry has no longer is left out, one that it did not have
    yet is not measured. Only an entry without claims of its own has those that Run.stands_beside() found."""
    claims = {c.quantity: c for c in run.entry.claims}
    for row in value["rows"]:
        stored = output.claim_of(row["claim"])
        claim = claims.get(stored.quantity) or (None if claims else stored)
        if claim is not None:
            numbers = {which: row[which]["value"] and Measured(**row[which]["value"]) for which in KINDS}
            run._rows[claim.quantity] = Row(claim, **numbers)
    run.tables = [Table(tuple(t["columns"]), t["rows"]) for t in value["tables"]]
    run.notes = value["notes"]
    run.shown = [Picture(**picture) for picture in value["pictures"]]
    run.seconds, run.complete, run.commit, run.code = (value[key] for key in ("seconds", "complete", "commit", "code"))
    return run


def load(entry, full, out):
    """The run of an entry that was kept; None where there is none, or where the programs, the Python or the scenes are
    others now."""
    run = Run(entry, full, out)
    try:
        value = json.loads(_file(run).read_text())
        return fill(run, value) if value["key"] == _key(entry, value["inputs"]) else None
    except (FileNotFoundError, KeyError, json.JSONDecodeError):
        return None


@dataclasses.dataclass(frozen=True)
class Outcome:
    """What became of an entry: its run, or the reason why there is none, as "not built yet"."""

    entry: object
    run: object = None
    reason: str = ""
