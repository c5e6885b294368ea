"""Renders every glTF file below some folders small, and puts the pictures on one sheet: what opens, and what does not
and why. Looked at against what each file should show."""

import argparse
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
LACUNA = ROOT / "build/release/bin/lacuna"
SIDE = 200  # pixels
COLUMNS = 10


def camera_for(printed):
    """The file's first camera, else one that sees the box from above, before and to the right of it."""
    views = re.findall(r'^  ".*": (\{"position.*\})$', printed, re.M) or re.findall(r'^  ".*": (\{"type.*\})$', printed, re.M)
    if views:
        return json.loads(views[0])
    numbers = [float(n) for n in re.findall(r"[-+.e\d]+", re.search(r"^  box: (.*)$", printed, re.M)[1].replace("to", ""))]
    low, high = numbers[:3], numbers[3:]
    middle = [(a + b) / 2 for a, b in zip(low, high)]
    reach = 0.5 * sum((b - a) ** 2 for a, b in zip(low, high)) ** 0.5
    return {"position": [m + 2.6 * reach * d for m, d in zip(middle, (0.46, 0.42, 0.78))], "target": middle, "fov": 45}


def run(file, *arguments):
    return subprocess.run([LACUNA, *arguments], capture_output=True, text=True, timeout=300, cwd=OUT,
                          env={**os.environ, "LACUNA_SCENES": f"{file.parent}:{OUT}"})


def render(index, file):
    """The file's picture, or why there is none."""
    checked = run(file, "check", "--scene", file)
    if checked.returncode != 0:
        return None, (checked.stderr.strip().splitlines() or ["no reason"])[-1]
    job = {"scene": file.name, "camera": camera_for(checked.stdout), "resolution": [SIDE, SIDE],
           "environment": {"file": "sky.exr"}, "integrator": {"type": "path", "max_depth": 12},
           "budget": {"iterations": 32}}
    path = OUT / f"{index:03}.json"
    path.write_text(json.dumps(job))
    rendered = run(file, "render", path)
    if rendered.returncode != 0:
        return None, (rendered.stderr.strip().splitlines() or ["no reason"])[-1]
    return path.with_suffix(".job") / "image.png", checked.stderr.count("warning")


def main():
    parser = argparse.ArgumentParser(prog="./dev samples", description=__doc__)
    parser.add_argument("folders", nargs="*", type=Path, default=[ROOT.parent / "shared/samples", ROOT.parent / "shared/cases"],
                        metavar="FOLDER", help="default: samples/ and cases/ of the folder shared/ beside the tree")
    options = parser.parse_args()
    base = {f: folder for folder in options.folders for f in folder.rglob("*") if f.suffix in (".glb", ".gltf")}
    files = sorted(base)
    if not files:
        parser.error(f"no .glb or .gltf below {', '.join(map(str, options.folders))}")
    shutil.rmtree(OUT, ignore_errors=True)
    OUT.mkdir(parents=True)
    # Light from above, so that white shapes differ from their background.
    subprocess.run(["oiiotool", "--create", "64x32", "3", "--fill:top=1.6,1.6,1.6:bottom=.02,.02,.02", "64x32", "-o", OUT / "sky.exr"],
                   check=True)
    pictures, rows = [], []
    for index, file in enumerate(files):
        print(f"\r{index + 1} of {len(files)}", end="", file=sys.stderr, flush=True)
        picture, note = render(index, file)
        at = ""
        if picture:
            at = f"{len(pictures) // COLUMNS + 1}.{len(pictures) % COLUMNS + 1}"
            pictures.append(picture)
            note = f"{note} warnings" if note else ""
        rows.append(f"| {index} | {at} | {file.relative_to(base[file])} | {note} |")
    print(file=sys.stderr)
    (OUT / "table.md").write_text("\n".join(["| | row.column | file | |", "| --- | --- | --- | --- |", *rows]) + "\n")
    if not pictures:
        sys.exit(f"none of {len(files)} files opened: {OUT / 'table.md'}")
    across = min(COLUMNS, len(pictures))
    down = -(-len(pictures) // across)
    subprocess.run(["oiiotool", *pictures, "--mosaic:pad=4", f"{across}x{down}", "--ch", "R,G,B", "-o", OUT / "sheet.png"], check=True)
    print(f"{len(pictures)} of {len(files)} files opened: {OUT / 'sheet.png'}, {OUT / 'table.md'}")


OUT = ROOT / "build/samples"

if __name__ == "__main__":
    main()
