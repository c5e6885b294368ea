"""The service on a real Slurm of one node: jobs and a sweep, cancelling, a time limit, a requeue, and kill -9 of
renderers, of slurmd and of the service at random moments. Nothing is lost or doubled, and the pictures have the bits of
jobs that this machine rendered by itself.

LACUNA_KILLS: kills of each kind (default 20).
"""

import collections
import json
import os
import pathlib
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.request

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from slurm_cluster import Cluster  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
BIN = pathlib.Path(os.environ.get("LACUNA_BIN", ROOT / "build/release/bin"))
ENDS = ("done", "failed", "cancelled")
KINDS = 3


def check(right, what):
    if not right:
        raise AssertionError(what)


def until(test, what, seconds=300):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        value = test()
        if value:
            return value
        time.sleep(0.05)
    raise AssertionError(f"in {seconds} s it did not happen: {what}")


def spec(kind, **more):
    return {"scene": "cornell.glb", "resolution": [96, 96], "seed": 1 + kind, "threads": 1, "layers": ["variance"],
            "budget": {"iterations": 120 + 40 * kind}, "checkpoint_seconds": 0.05, **more}


ENDLESS = {"resolution": [256, 256], "budget": {"seconds": 600}}


class Service:
    """lacuna-server on the cluster; it can be killed and started again."""

    options = ("--executor", "slurm", "--slurm-poll", "0.3", "--grace", "3", "--max-attempts", "1000", "--jobs", "16",
               "--memory-limit", "512M", "--port", "0")

    def __init__(self, cluster, folder):
        self.cluster, self.folder = cluster, folder
        self.data = folder / "data"
        self.start()

    def start(self, *more):
        self.process = subprocess.Popen(
            [BIN / "lacuna-server", *self.options, "--data", self.data, "--scenes", ROOT / "jobs/scenes", "--web",
             ROOT / "web", *more],
            env=self.cluster.environment, stdout=subprocess.PIPE, stderr=open(self.folder / "service.log", "ab"),
            text=True)
        line = self.process.stdout.readline()
        found = re.search(r"http://\S+", line)
        check(found, f"the service said {line!r}; see {self.folder}/service.log")
        self.url = found.group()

    def end(self, number=signal.SIGKILL):
        self.process.send_signal(number)
        self.process.wait()

    def ask(self, target, body=None, method=None, key=None):
        """(status, JSON); None where nobody answers."""
        headers = {"Content-Type": "application/json"} | ({"Idempotency-Key": key} if key else {})
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(self.url + target.lstrip("/"), data=data, headers=headers, method=method)
        try:
            with urllib.request.urlopen(request, timeout=30) as answer:
                return answer.status, json.load(answer)
        except urllib.error.HTTPError as error:
            return error.code, json.load(error)
        except (OSError, ValueError):
            return None

    def post(self, job, key=None):
        answer = self.ask("/api/jobs", job, key=key)
        check(answer and answer[0] in (200, 201), answer)
        return answer[1]["id"]

    def job(self, name):
        return self.ask(f"/api/jobs/{name}")[1]

    def state(self, name):
        return self.job(name)["state"]["state"]

    def reaches(self, name, state, seconds=300):
        def there():
            now = self.job(name)
            over = now["state"]["state"] in ENDS
            check(not over or now["state"]["state"] == state, f"{name} is {now['state']}")
            return now["state"]["state"] == state and now
        return until(there, f"{name} is {state}", seconds)

    def dir(self, name):
        return self.data / "jobs" / name

    def slurm_job(self, name):
        """Slurm's number of the job's submission, once it is known."""
        def number():
            try:
                return json.loads((self.dir(name) / "slurm.json").read_text())["job"]
            except (OSError, ValueError):
                return 0
        return until(number, f"{name} is submitted", 60)


def whole(folder, kind):
    """A job of this kind, rendered without the service."""
    file = folder / f"whole{kind}.json"
    file.write_text(json.dumps(spec(kind)))
    environment = {**os.environ, "LACUNA_SCENES": str(ROOT / "jobs/scenes"), "LACUNA_DATA": str(folder / "local")}
    subprocess.run([BIN / "lacuna", "render", file, "-q"], cwd=folder, env=environment, check=True)
    return folder / f"whole{kind}.job"


def same_bits(one, other):
    done = subprocess.run([BIN / "lacuna", "compare", one / "image.exr", other / "image.exr"],
                          capture_output=True, text=True, check=False)
    check(re.search(r"^mse +0$", done.stdout, re.MULTILINE), f"{one} and {other} differ: {done.stdout}{done.stderr}")


class Trial:
    """All checks share one service and one cluster."""

    def __init__(self, cluster, folder, kills):
        self.cluster, self.folder, self.kills = cluster, folder, kills
        self.wholes = [whole(folder, kind) for kind in range(KINDS)]
        self.service = Service(cluster, folder)

    def submissions(self):
        """Names of all jobs that Slurm remembers, by Lacuna's job."""
        found = collections.defaultdict(list)
        for line in self.cluster.run("squeue", "-h", "--states=all", "-o", "%i|%T|%r|%j").splitlines():
            number, state, reason, name = line.split("|", 3)
            if match := re.fullmatch(r"lacuna-(\d{8}-\d{6}-\w{6})-\w{8}", name):
                found[match.group(1)].append((int(number), state, reason))
        return found

    def some_jobs(self):
        ids = [self.service.post(spec(n % KINDS)) for n in range(12)]
        for n, name in enumerate(ids):
            self.service.reaches(name, "done")
            same_bits(self.service.dir(name), self.wholes[n % KINDS])
        seen = self.submissions()
        check(all(len(seen[name]) == 1 for name in ids), f"each is submitted once: {seen}")
        return f"{len(ids)} jobs done, each submitted once, same bits as local"

    def a_sweep(self):
        status, sweep = self.service.ask("/api/sweeps", {
            "job": {**spec(0), "budget": {"iterations": 20}}, "alone": False,
            "axes": {"/seed": [1, 2, 3, 4, 5], "/integrator": ["path", "bdpt"], "/threads": [1, 2], "/resolution": [[32, 32], [48, 48]]}})
        check(status == 201, sweep)
        over = until(lambda: (now := self.service.ask(f"/api/sweeps/{sweep['id']}")[1])["state"] == "done" and now,
                     "the sweep is done", 600)
        check(over["counts"]["done"] == len(over["runs"]) == 40, over["counts"])
        return f"a sweep of {len(over['runs'])} runs is done"

    def a_sweep_of_the_shell(self):
        """`lacuna sweep --executor slurm`, which is killed and begun again until all runs are done."""
        file = self.folder / "shell.json"
        file.write_text(json.dumps({"job": spec(0), "alone": False, "zip": [{
            "/seed": [spec(kind)["seed"] for kind in range(KINDS)],
            "/budget": [spec(kind)["budget"] for kind in range(KINDS)]}], "axes": {"/threads": [1, 2]}}))
        command = [BIN / "lacuna", "sweep", file, "--executor", "slurm", "--slurm-poll", "0.3", "--jobs", "4", "-q"]
        environment = {**self.cluster.environment, "LACUNA_SCENES": str(ROOT / "jobs/scenes"),
                       "LACUNA_DATA": str(self.folder / "shell-data")}
        for times in range(6):
            process = subprocess.Popen(command, cwd=self.folder, env=environment)
            time.sleep(random.uniform(0, 4))
            process.kill()
            process.wait()
        subprocess.run(command, cwd=self.folder, env=environment, check=True)
        runs = sorted((self.folder / "shell.sweep/runs").iterdir())
        check(len(runs) == 2 * KINDS, runs)
        for run in runs:
            check(json.loads((run / "outcome.json").read_text())["state"] == "done", run)
            same_bits(run, self.wholes[(int(run.name[:4]) - 1) % KINDS])
        return f"a sweep of {len(runs)} runs from the shell, whose command was killed {times + 1} times"

    def cancelling(self):
        running = self.service.post(spec(0, **ENDLESS))
        self.service.reaches(running, "running")
        waiting = [self.service.post(spec(0, **ENDLESS)) for _ in range(3)]
        numbers = [self.service.slurm_job(name) for name in waiting]
        for name in [running, *waiting]:
            self.service.ask(f"/api/jobs/{name}/cancel", {}, "POST")
            self.service.reaches(name, "cancelled")
        check((self.service.dir(running) / "checkpoint.bin").exists(), "it wrote a checkpoint")
        held = self.service.post(spec(0, **ENDLESS))
        self.service.reaches(held, "running")
        self.service.ask(f"/api/jobs/{held}", {"held": True}, "PATCH")
        self.service.reaches(held, "held")
        self.service.ask(f"/api/jobs/{held}", {"held": False}, "PATCH")
        self.service.reaches(held, "running")
        self.cluster.run("scancel", str(self.service.slurm_job(held)))
        over = self.service.reaches(held, "failed")
        live = self.cluster.run("squeue", "-h", "-o", "%i").split()
        check(not set(map(str, numbers)) & set(live), "Slurm has none of them any more")
        check("was cancelled in Slurm" in over["state"]["error"], over["state"])
        return f"cancelled running and waiting, held and released; scancel by hand: {over['state']['error']!r}"

    def a_refusal(self):
        self.service.end(signal.SIGTERM)
        self.service.start("--slurm-args", "--partition=nowhere")
        name = self.service.post(spec(0))
        words = "Invalid partition name specified"
        waits = until(lambda: (now := self.service.job(name))["state"]["obstacle"] and now, "sbatch refuses it")
        check(words in waits["state"]["obstacle"] and waits["state"]["state"] == "queued", waits["state"])
        health = self.service.ask("/health")[1]
        check(words in health["obstacle"], health)
        self.service.end(signal.SIGTERM)
        self.service.start()
        self.service.reaches(name, "done")
        return f"{waits['state']['obstacle']!r}, and done once the partition is right"

    def a_time_limit(self):
        self.service.end(signal.SIGTERM)
        self.service.start("--slurm-args", "--time=1")  # Slurm counts in minutes, and looks every half minute
        name = self.service.post(spec(0, resolution=[256, 256], budget={"seconds": 75}))
        over = self.service.reaches(name, "done", 600)
        check(over["state"]["attempts"] >= 2, over["state"])
        ended = [state for number, state, _ in self.submissions()[name]]
        self.service.end(signal.SIGTERM)
        self.service.start()
        return f"75 s of rendering in slices of at most a minute: Slurm says {', '.join(ended)}; done"

    def a_requeue(self):
        name = self.service.post(spec(0, budget={"iterations": 4000}))
        self.service.reaches(name, "running")
        until(lambda: (self.service.dir(name) / "checkpoint.bin").exists(), "it has a checkpoint")
        number = str(self.service.slurm_job(name))
        self.cluster.run("scontrol", "requeue", number)
        place = until(lambda: "waits" in (text := self.service.job(name)["state"]["place"]) and text, "it waits again")
        over = self.service.reaches(name, "done")
        check(over["state"]["attempts"] == 2, over["state"])
        check(len(self.submissions()[name]) == 1, "it is the same submission")
        file = self.folder / "requeued.json"
        file.write_text(json.dumps(spec(0, budget={"iterations": 4000})))
        environment = {**os.environ, "LACUNA_SCENES": str(ROOT / "jobs/scenes")}
        subprocess.run([BIN / "lacuna", "render", file, "-q"], cwd=self.folder, env=environment, check=True)
        same_bits(self.service.dir(name), self.folder / "requeued.job")
        return f"{place!r}, then done in attempt 2 with the same bits"

    def renderers(self):
        """Processes of `lacuna render` below the data folder."""
        found = []
        for entry in pathlib.Path("/proc").iterdir():
            try:
                words = (entry / "cmdline").read_bytes().split(b"\0")
            except (OSError, ValueError):
                continue
            if len(words) > 2 and words[0].endswith(b"/lacuna") and words[2].startswith(bytes(self.service.data)):
                found.append(int(entry.name))
        return found

    def kill(self, what):
        if what == "renderer":
            for process in self.renderers()[:1]:
                os.kill(process, signal.SIGKILL)
                return True
            return False
        if what == "slurmd":
            self.cluster.kill("slurmd")
            if random.random() < 0.3:
                time.sleep(random.uniform(0, 15))  # long enough for the node to be given up, now and then
            self.cluster.start("slurmd")
            self.cluster.wait_for_node()
            return True
        self.service.end()
        if random.random() < 0.3:
            time.sleep(random.uniform(0, 3))
        self.service.start()
        return True

    def kills_at_random(self):
        left = collections.Counter(renderer=self.kills, slurmd=self.kills, service=self.kills)
        wishes = {}
        while +left:
            for _ in range(random.randrange(3)):
                key = f"wish-{len(wishes)}"
                wishes[key] = [len(wishes) % KINDS, self.service.post(spec(len(wishes) % KINDS, label=key), key)]
            time.sleep(random.uniform(0, 2))
            what = random.choice(list((+left).keys()))
            if self.kill(what):
                left[what] -= 1
        over = until(lambda: all(self.service.state(name) in ENDS for _, name in wishes.values()),
                     "every job is over", 900)
        check(over, "over")
        listed = self.service.ask("/api/jobs?limit=1000")[1]["jobs"]
        labels = collections.Counter(job["label"] for job in listed if job["label"].startswith("wish-"))
        check(set(labels) == set(wishes) and set(labels.values()) <= {1}, "none is lost, none doubled")
        attempts = 0
        for kind, name in wishes.values():
            job = self.service.job(name)
            check(job["state"]["state"] == "done", job["state"])
            attempts += job["state"]["attempts"]
            same_bits(self.service.dir(name), self.wholes[kind])
            alive = [state for _, state, _ in self.submissions()[name] if state in ("PENDING", "RUNNING")]
            check(not alive, f"a second submission of {name} is {alive}")
        return (f"{len(wishes)} jobs, each done once with the same bits, in {attempts} attempts; killed {self.kills} "
                "times each: the renderer, slurmd, the service")


def main():
    kills = int(os.environ.get("LACUNA_KILLS", "20"))
    chosen = sys.argv[1:] or ["some_jobs", "a_sweep", "a_sweep_of_the_shell", "cancelling", "a_refusal", "a_time_limit", "a_requeue",
                              "kills_at_random"]
    seed = int(os.environ.get("LACUNA_SEED", "1"))
    random.seed(seed)
    folder = pathlib.Path(tempfile.mkdtemp(prefix="lacuna-soak-"))
    with Cluster() as cluster:
        print(cluster.run("sbatch", "--version").strip(), "on one node of 2 cores, seed", seed, flush=True)
        trial = Trial(cluster, folder, kills)
        try:
            for name in chosen:
                began = time.monotonic()
                said = getattr(trial, name)()
                print(f"{name}: {said} ({time.monotonic() - began:.0f} s)", flush=True)
            trial.service.end(signal.SIGTERM)
        except BaseException:
            print(f"what is left of it lies in {folder} and {cluster.folder}", flush=True)
            trial.service.process.kill()
            cluster.keep = True
            raise
    shutil.rmtree(folder)


if __name__ == "__main__":
    main()
