"""How long a job takes to end after SIGTERM, at several moments of work that takes minutes. Fails above 2 s."""

import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = pathlib.Path(os.environ.get("LACUNA_BIN", ROOT / "build/release/bin")) / "lacuna"
ALLOWED = 2.0  # seconds
MOMENTS = (0.1, 1, 3, 8, 20)  # seconds after the start


def deep(**connections):
    return {"scene": "furnace.glb",
            "integrator": {"type": "bdpt", "max_depth": 1000, "roulette_depth": 1000, "connections": connections}}


def guided(guide, resolution):
    return {"scene": "hairball.glb", "integrator": {"type": "path", "guide": {"type": guide}},
            "analysis": {"resolution": resolution}}


JOBS = {
    "bdpt, 1000 edges, paired": deep(type="paired"),
    "bdpt, 1000 edges, importance_cache": deep(type="importance_cache", light_paths=100),
    "bdpt, 1000 edges, skeleton": deep(type="skeleton"),
    "the layers of 560 strategies": {"scene": "ajar.glb", "camera": "room", "resolution": [256, 256],
                                     "integrator": {"type": "bdpt", "max_depth": 32}, "layers": ["strategies"]},
    "portals at 256": guided("portals", 256),
    "skeleton at 512": guided("skeleton", 512),
}


def answer(spec, moment, folder):
    """Seconds from SIGTERM to the end; nothing if the job was done before."""
    file = folder / "a.json"
    file.write_text(json.dumps({"resolution": [64, 64], "budget": {"seconds": 600}, **spec}))
    environment = {**os.environ, "LACUNA_DATA": str(folder / "data"), "LACUNA_SCENES": str(ROOT / "jobs/scenes")}
    with subprocess.Popen([PROGRAM, "render", file, "-q"], cwd=folder, env=environment) as job:
        time.sleep(moment)
        if job.poll() is not None:
            return None
        sent = time.monotonic()
        job.send_signal(signal.SIGTERM)
        code = job.wait()
        seconds = time.monotonic() - sent
    # Before it handles signals it ends by them.
    if code not in (75, -signal.SIGTERM):
        sys.exit(f"exit code {code} in place of 75")
    return seconds


def main():
    good = True
    for name, spec in JOBS.items():
        for moment in MOMENTS:
            with tempfile.TemporaryDirectory() as folder:
                seconds = answer(spec, moment, pathlib.Path(folder))
            if seconds is None:
                print(f"{name}, {moment:g} s: done before")
                continue
            good = good and seconds <= ALLOWED
            print(f"{name}, {moment:g} s: {seconds:.2f} s", flush=True)
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
