"""How each method would scale to many cores, from its traces (`lacuna render --trace`).

A trace has every piece of work as it is handed out, with its CPU time: the bodies of each loop, and the serial work
between loops. A simulation runs the same pieces on some number of threads: serial work as it is, the bodies of a loop in
their order, each by the first thread that is free. So serial work and uneven bodies are predicted. Shared caches and
memory bandwidth are not: how much longer the same bodies take on two threads than on one is measured, and printed beside.

Each method runs a fixed number of iterations on one thread, on two, and on 64, which take turns on the cores that there
are: their trace is the one that is simulated, since some methods divide their work by the number of threads. On one and
two threads the fastest of `ROUNDS` runs counts. The prediction for two threads is held against their measured time."""

import heapq
import json

ROUNDS = 2
LEAST_EFFICIENCY = (0.8, 0.6)  # on 64 threads, at the large and the small size
THREADS = (2, 8, 16, 64, 128)
EDGES = {"max_depth": 6}
METHODS = {
    "path": {"type": "path"},
    "path, reuse 16": {"type": "path", "reuse": 16},
    "path, reuse 64, learned_skeleton": {"type": "path", "reuse": 64, "guide": {"type": "learned_skeleton"}},
    "bdpt": {"type": "bdpt"},
    "bdpt, skeleton": {"type": "bdpt", "connections": {"type": "skeleton"}},
    "vcm": {"type": "vcm"},
    "sppm": {"type": "sppm"},
    "metropolis": {"type": "metropolis"},
    "many_lights, probabilistic": {"type": "many_lights", "visibility": {"type": "probabilistic"}},
    "many_lights, view_maps": {"type": "many_lights", "visibility": {"type": "view_maps"}},
}
SCENES = {"door": {"scene": "door/scene.glb", "camera": "corner"},
          "sponza": {"scene": "sponza/scene.glb", "camera": "directional-light-from-power"}}
SIZES = {"large": [1920, 1080], "small": [512, 512]}
# Sections of a trace that are not of iterations: preparation, and what follows an iteration at times of its own.
OUTSIDE = ("other", "load", "prepare", "analysis", "evaluate", "checkpoint", "preview", "progress", "write")


class Piece:
    """A parallel loop with the CPU seconds of each body, or serial work (no bodies); `seconds` by the wall clock."""

    def __init__(self, section, begin, end, cpu, bodies=()):
        self.section, self.begin, self.seconds, self.bodies, self.cpu = section, begin, end - begin, bodies, cpu

    def on(self, threads, longer=1):
        """Seconds on so many threads, where a body takes `longer` times as long."""
        return longer * makespan(self.bodies, threads) if self.bodies else self.cpu

    def busy(self):
        return sum(self.bodies) if self.bodies else self.cpu


def pieces(trace):
    """The work of the iterations in order, without the first of several: it makes what later ones use again."""
    loops, work = {}, []
    for e in trace["traceEvents"]:
        begin, end, body = e["ts"] / 1e6, (e["ts"] + e["dur"]) / 1e6, e["args"]["body"]
        if body < 0:
            work.append(Piece(e["name"], begin, end, e["args"]["cpu"] / 1e6))
        else:
            loops.setdefault(e["args"]["loop"], []).append((body, begin, end, e["name"], e["args"]["cpu"] / 1e6))
    for bodies in loops.values():
        bodies.sort()
        work.append(Piece(bodies[0][3], min(b[1] for b in bodies), max(b[2] for b in bodies), 0,
                          [b[4] for b in bodies]))
    work = sorted((w for w in work if not w.section.startswith(OUTSIDE)), key=lambda w: w.begin)
    ends = [i for i, w in enumerate(work) if w.section == "film" and w.bodies]
    return work[ends[0] + 1:] if len(ends) > 1 else work


def makespan(bodies, threads):
    """Of bodies that are handed out in their order, each to the first free thread."""
    if threads >= len(bodies):
        return max(bodies, default=0)
    free = [0.0] * threads
    for seconds in bodies:
        heapq.heapreplace(free, free[0] + seconds)
    return max(free)


def predicted(work, threads, longer=1):
    return sum(w.on(threads, longer) for w in work)


def measured(bench, job, threads):
    """The pieces of the fastest run, and its peak memory."""
    best = None
    for _ in range(ROUNDS if threads < 64 else 1):
        trace = bench.folder / "trace.json"
        _, report = bench.render("scaling", job, "--threads", str(threads), "--trace", str(trace))
        work = pieces(json.loads(trace.read_text()))
        if best is None or wall(work) < wall(best[0]):
            best = (work, report["machine"]["peak_memory_bytes"])
    return best


def wall(work):
    return sum(w.seconds for w in work)


def waiting(work, threads):
    """Sections by the seconds that they take beyond a perfect division of all work, the longest first."""
    lost = {}
    for w in work:
        lost[w.section] = lost.get(w.section, 0) + w.on(threads) - w.busy() / threads
    return sorted(lost.items(), key=lambda item: -item[1])


def run(bench, options):
    print(f"{'':36} {'serial':>7} {'on 2':>5} {'pred':>5} {'work':>5} | efficiency on " +
          ", ".join(str(t) for t in THREADS[1:]))
    for scene in options.scaling_scenes:
        where = SCENES[scene]
        for size in options.scaling_sizes:
            for name, method in METHODS.items():
                if options.scaling_methods and name not in options.scaling_methods:
                    continue
                one_method(bench, f"{scene} {size}, {name}", {
                    **where, "resolution": SIZES[size], "integrator": {**method, **EDGES},
                    "budget": {"iterations": options.scaling_iterations}, "checkpoint_seconds": 86400})


def one_method(bench, name, job):
    one, _ = measured(bench, job, 1)
    two, memory_of_two = measured(bench, job, 2)
    many, memory = measured(bench, job, 64)
    busy = [sum(sum(w.bodies) for w in work) for work in (one, two)]
    longer = busy[1] / max(busy[0], 1e-9)
    work = sum(w.busy() for w in many)
    serial = sum(w.cpu for w in many if not w.bodies) / work
    efficiency = {t: work / (t * predicted(many, t)) for t in THREADS}
    print(f"{name:44} {serial:7.4f} {wall(one) / wall(two):5.2f} {wall(one) / predicted(one, 2):5.2f} {longer:5.2f} | " +
          " ".join(f"{efficiency[t]:.2f}" for t in THREADS[1:]) + f"   {memory_of_two / 2**20:.0f}, {memory / 2**20:.0f} MiB", flush=True)
    for section, seconds in waiting(many, 64)[:2]:
        print(f"    {section}: {seconds / predicted(many, 64):.0%} of the time on 64 threads")
    ratio = predicted(one, 2, longer) / wall(two)
    bench.figure(f"{name}: predicted / measured time on 2 threads", f"{ratio:.3f}", "within .97 and 1.03",
                 0.97 <= ratio <= 1.03)
    least = LEAST_EFFICIENCY[job["resolution"] == SIZES["small"]]
    bench.figure(f"{name}: efficiency on 64 threads", f"{efficiency[64]:.2f}", f"at least {least}", efficiency[64] >= least)
    bench.figure(f"{name}: serial share", f"{serial:.4f}", "at most .01", serial <= 0.01)
