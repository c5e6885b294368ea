"""The demo: starts the service, posts the demo jobs, shows them going on, and prints error against time."""

import argparse
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import time
import urllib.error
import urllib.request

ROOT = pathlib.Path(__file__).resolve().parents[2]
BIN = ROOT / "build/release/bin"
# Scenes of the project, always there; together about two minutes on two cores. Through the door that is ajar three
# methods look, in the same time.
JOBS = ["cornell", "atrium", "ajar", "ajar-paired", "ajar-skeleton"]
ANALYSED = "ajar-nodes"  # and one that looks at the shape of the empty space
NAME = 46  # columns of a job's name
ENDED = {"done", "failed", "cancelled"}


def call(base, path, body=None):
    request = urllib.request.Request(base + path, data=body,
                                     headers={"Content-Type": "application/json"} if body else {})
    try:
        with urllib.request.urlopen(request, timeout=30) as answer:
            return json.load(answer)
    except urllib.error.HTTPError as error:
        sys.exit(f"demo: {path}: {error.code} {error.read().decode(errors='replace')}")


def start_server(port, data):
    server = subprocess.Popen(
        [BIN / "lacuna-server", "--port", str(port), "--data", str(data)],
        stdout=subprocess.PIPE, text=True)
    line = server.stdout.readline()
    if "http://" not in line:
        server.wait()
        sys.exit(f"demo: the service did not start: {line.strip() or 'see its message above'}")
    return server, line[line.index("http://"):].strip().rstrip("/")


def bar(job, width):
    state = job["state"]
    progress = job.get("progress") or {}
    share = 1.0 if state == "done" else progress.get("share", 0.0) if state == "running" else 0.0
    filled = int(share * 24)
    text = f"{job['label'] or job['scene']:<{NAME}.{NAME}} [{'#' * filled}{'.' * (24 - filled)}] {state:<10}"
    if state == "running":
        text += f" {job.get('phase', ''):<10}"
    if progress.get("error") is not None and state in ("running", "done"):
        text += f" {progress['error_metric']} {progress['error']:.3g}"
    return text[:width]


def watch(base, ids):
    """Shows the jobs until all have ended: bars on a terminal, a line a change otherwise."""
    terminal = sys.stdout.isatty()
    last = {}
    drawn = 0
    while True:
        jobs = [job for job in call(base, "/api/jobs")["jobs"] if job["id"] in ids]
        jobs.sort(key=lambda job: ids.index(job["id"]))
        if terminal:
            if drawn:
                sys.stdout.write(f"\033[{drawn}A")
            width = shutil.get_terminal_size().columns - 1
            for job in jobs:
                sys.stdout.write("\033[K" + bar(job, width) + "\n")
            sys.stdout.flush()
            drawn = len(jobs)
        else:
            for job in jobs:
                key = (job["state"], int(10 * (job.get("progress") or {}).get("share", 0)))
                if last.get(job["id"]) != key:
                    last[job["id"]] = key
                    print(bar(job, 120), flush=True)
        if all(job["state"] in ENDED for job in jobs):
            return jobs
        time.sleep(0.5)


def rows_of(base, job):
    with urllib.request.urlopen(f"{base}/api/jobs/{job}/files/curve.csv", timeout=30) as answer:
        lines = answer.read().decode().splitlines()
    names = lines[0].split(",")
    return [dict(zip(names, line.split(","))) for line in lines[1:]]


def table(base, jobs):
    instants = [1, 2, 5, 10]
    print("\nrelMSE against render time (seconds); * where the reference's own noise is reached")
    print(f"{'job':<{NAME}}" + "".join(f"{str(t) + ' s':>12}" for t in instants) + f"{'rays/s':>12}")
    for job in jobs:
        name = f"{(job['label'] or job['scene']):<{NAME}.{NAME}}"
        if job["state"] != "done":
            print(name + f"  {job['state']}")
            continue
        rows = rows_of(base, job["id"])
        cells = []
        for instant in instants:
            # The first row at or after the instant; rows are log-spaced, the last is the job's end.
            row = next((r for r in rows if float(r["seconds"]) >= 0.95 * instant), None)
            error = row and row["relmse"]
            cells.append(f"{float(error):.3g}{'*' if row['at_floor'] == '1' else ' '}" if error else "- ")
        last = rows[-1]
        rate = (int(last["rays"]) + int(last["shadow_rays"])) / float(last["seconds"])
        print(name + "".join(f"{cell:>12}" for cell in cells) + f"{rate / 1e6:>10.2f} M")


def report_of(base, job):
    with urllib.request.urlopen(f"{base}/api/jobs/{job}/files/report.json", timeout=30) as answer:
        return json.load(answer)


def artefacts(base, job):
    """What of the analysis was made now, and what an earlier run had left in the cache."""
    if job["state"] != "done":
        return
    made = report_of(base, job["id"])["artefacts"]
    print(f"\nthe shape of the empty space, for \"{job['label']}\":")
    for key, text in (("built", "built now"), ("loaded", "found in the cache")):
        if made[key]:
            seconds = sum(a["seconds"] for a in made[key])
            print(f"  {text}: {', '.join(a['name'] for a in made[key])} ({seconds:.2f} s)")


def main():
    parser = argparse.ArgumentParser(prog="./dev demo", description=__doc__)
    parser.add_argument("--exit", action="store_true", help="end after the table instead of serving on")
    parser.add_argument("--port", type=int, default=8017, help="0: any free one")
    parser.add_argument("--data", type=pathlib.Path, default=pathlib.Path(os.environ.get("LACUNA_DATA", "lacuna-data")))
    options = parser.parse_args()
    # Ended by a signal, the service must go too.
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    server, base = start_server(options.port, options.data)
    try:
        print(f"the service listens on {base}/", flush=True)
        ids = []
        for name in [*JOBS, ANALYSED]:
            body = (ROOT / "jobs/examples" / f"{name}.json").read_bytes()
            ids.append(call(base, "/api/jobs", body)["id"])
        jobs = watch(base, ids)
        table(base, jobs[:-1])
        artefacts(base, jobs[-1])
        print(f"\npictures and curves: {base}/\nresults on disk:     {options.data.resolve() / 'jobs'}", flush=True)
        failed = any(job["state"] != "done" for job in jobs)
        if not options.exit:
            print("serving until Ctrl-C", flush=True)
            server.wait()
        return 1 if failed else 0
    except KeyboardInterrupt:
        return 0
    finally:
        server.terminate()
        server.wait()


if __name__ == "__main__":
    sys.exit(main())
