"""Results in the tree, docs/reproduction/NAME.json with a row of pictures, NAME.jpg: what the page is made of. Each tells
the commit that it was measured at, so that an entry can be measured again without the others."""

import json
import math
import pathlib
import subprocess

from harness import child, output
from harness.kept import Outcome, fill, write_json
from harness.run import Run

FOLDER = child.ROOT / "docs/reproduction"
WIDTH, MOST_WIDTH, COLUMNS, QUALITY = 1200, 300, 6, 80  # pixels of all pictures and of one, columns at most, JPEG


def file(entry):
    return FOLDER / f"{entry.name}.json"


def pictures(entry):
    return FOLDER / f"{entry.name}.jpg"


def write(run):
    """Puts a run into the tree."""
    value = output.run_json(run)
    value["notes"] = [note.replace(f"{child.ROOT}/", "") for note in value["notes"]]
    for picture in value["pictures"]:
        picture["file"] = pathlib.Path(picture["file"]).parent.name
    write_json(file(run.entry), value)
    _draw(run)


def _opened(picture):
    """The arguments of oiiotool. A layer is linear: shares and others from 0 to 1."""
    if not picture.layer:
        return [picture.file]
    channels = ",".join(f"{channel}={picture.layer}.{channel}" for channel in "RGB")
    return [picture.file, "--ch", channels, "--colorconvert", "linear", "sRGB"]


def _draw(run):
    """The pictures side by side in as few rows as hold them, as wide as each other."""
    together = pictures(run.entry)
    if not run.shown:
        together.unlink(missing_ok=True)
        return
    rows = math.ceil(len(run.shown) / COLUMNS)
    columns = math.ceil(len(run.shown) / rows)
    width = f"{min(WIDTH // columns, MOST_WIDTH)}x0"  # 0: in proportion
    scaled = [part for picture in run.shown for part in (*_opened(picture), "--resize", width)]
    done = subprocess.run(["oiiotool", *scaled, "--mosaic:pad=2", f"{columns}x{rows}", "--nosoftwareattrib", "--compression",
                           f"jpeg:{QUALITY}", "-o", str(together)], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise child.Failed(f"oiiotool ended with {done.returncode}: {done.stdout}{done.stderr}", done.returncode)


def load(entry):
    """The run of an entry in the tree; None: there is none."""
    if not file(entry).is_file():
        return None
    value = json.loads(file(entry).read_text())
    return fill(Run(entry, value["version"] == "full", child.ROOT), value)


def outcomes(entries):
    """Of each entry what the tree has of it."""
    for entry in entries:
        run = load(entry) if entry.built else None
        yield Outcome(entry, run, "" if run else "not run" if entry.built else "not built yet")
