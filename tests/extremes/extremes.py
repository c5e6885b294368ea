"""The ends of what there is, where they take too long for every test run: each is one check, with what it took."""

import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
BIN = ROOT / "build/release/bin"
OUT_OF_MEMORY = 71  # exit code of `lacuna`


class Checks:
    def __init__(self):
        self.passed = self.failed = 0

    def check(self, name, good, told):
        self.passed += good
        self.failed += not good
        print(f"{'ok' if good else 'FAILED':<7} {name:<44} {told}", flush=True)


def methods(checks, _):
    """Every registered method through every extreme: the matrix that extremes.cpp makes."""
    last = ""
    with subprocess.Popen([BIN / "extremes"], stdout=subprocess.PIPE, text=True) as program:
        for last in program.stdout:
            print(last, end="", flush=True)
    counts = re.fullmatch(r"(\d+) passed, (\d+) failed\n", last)
    if not counts:
        return checks.check("methods", False, f"exit {program.returncode}, without its counts")
    checks.passed += int(counts[1])
    checks.failed += int(counts[2])
    if program.returncode != (1 if int(counts[2]) else 0):
        checks.check("methods", False, f"exit {program.returncode}")


def resolutions(checks, folder):
    """Every power of two from one voxel on: done, or refused before memory is taken, with what it would take."""
    for scene in ("ajar.glb", "door/scene.glb", "corridor/scene.glb", "sponza/scene.glb"):
        for resolution in (1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024, 2048):
            begin = time.monotonic()
            done = subprocess.run(
                [BIN / "lacuna", "analyze", scene, "--resolution", str(resolution), "--no-cache", "--json"],
                capture_output=True, text=True, env={**os.environ, "LACUNA_DATA": str(folder)}, check=False)
            seconds = time.monotonic() - begin
            name = f"{scene} at {resolution}"
            if done.returncode == 0:
                told = json.loads(done.stdout)
                whole = told["components"] == told["domain_components"]
                checks.check(name, whole, f"{'x'.join(map(str, told['grid']))}: {told['nodes']} nodes, "
                             f"{seconds:.2f} s, {told['peak_memory_bytes'] / 1e6:.0f} MB")
            else:
                refused = done.returncode == OUT_OF_MEMORY and re.search(r"\d.* [MG]i?B", done.stderr)
                checks.check(name, bool(refused), f"exit {done.returncode}, {seconds:.2f} s: {done.stderr.strip()}")


def pebbles(checks, _):
    """10^6 separate pebbles: as many cavities to be pierced."""
    done = subprocess.run([BIN / "bench_shape", "pebbles:100"], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        return checks.check("10^6 pebbles", False, f"exit {done.returncode}: {done.stderr.strip()}")
    told = json.loads(done.stdout)
    checks.check("10^6 pebbles", told["squares_pierced"] >= 10**6,
                 f"{told['nodes']} nodes, {told['squares_pierced']} squares pierced, {told['seconds'][0]:.1f} s, "
                 f"{told['peak_bytes'] / 1e6:.0f} MB")


CHECKS = {"methods": methods, "resolutions": resolutions, "pebbles": pebbles}


def main():
    if {"-h", "--help"} & set(sys.argv):
        print(f"usage: ./dev extremes [CHECK ...]\n\nchecks, all without a name: {', '.join(CHECKS)}")
        return 0
    wanted = sys.argv[1:] or CHECKS
    if unknown := [c for c in wanted if c not in CHECKS]:
        print(f"extremes: there is no {unknown[0]}; there are {', '.join(CHECKS)}", file=sys.stderr)
        return 2
    checks = Checks()
    with tempfile.TemporaryDirectory(prefix="lacuna-extremes-") as folder:
        for name in wanted:
            CHECKS[name](checks, pathlib.Path(folder))
    print(f"{checks.passed} passed, {checks.failed} failed")
    return 1 if checks.failed else 0


if __name__ == "__main__":
    sys.exit(main())
