"""How each method would scale to many cores, from its traces (`lacuna render --trace`).

A trace of one thread has every piece of work as it is handed out: the bodies of each loop, and the serial work between
loops. A simulation runs the same pieces on more threads: serial work as it is, the bodies of a loop in their order, each
by the first thread that is free. So serial work and uneven bodies are predicted. Shared caches and memory bandwidth are
not: how much longer the same bodies take on two threads than on one is measured, and printed beside. The prediction for
two threads is held against the measured time of two threads.

Each method runs a few iterations at a fixed number, on one and two threads in turn; of each the fastest of `ROUNDS`
counts."""

import heapq
import json

ROUNDS = 3
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


def pieces(trace):
    """The work of the iterations in order: (section, seconds of each body), or (section, seconds) of serial work."""
    loops, serial = {}, []
    for e in trace["traceEvents"]:
        if e["args"]["body"] >= 0:
            loops.setdefault(e["args"]["loop"], (e["name"], {}))[1][e["args"]["body"]] = e["dur"] / 1e6
        else:
            serial.append((e["args"]["loop"], e["ts"], e["name"], e["dur"] / 1e6))
    work, done = [], set()
    for loop, _, section, seconds in sorted(serial):
        for before in sorted(k for k in loops if k < loop and k not in done):
            done.add(before)
            work.append((loops[before][0], [t for _, t in sorted(loops[before][1].items())]))
        work.append((section, seconds))
    return [w for w in work if not w[0].startswith(OUTSIDE)]


def makespan(bodies, threads):
    """Of bodies that are handed out in their order, each to the first free thread."""
    if threads >= len(bodies):
        return max(bodies, default=0)
    free = [0.0] * threads
    for seconds in bodies:
        heapq.heapreplace(free, free[0] + seconds)
    return max(free)


def predicted(work, threads, longer=1):
    """Seconds; bodies take `longer` times as long as in the trace."""
    return sum(longer * makespan(w, threads) if isinstance(w, list) else w for _, w in work)


def measured(bench, job, threads):
    """The pieces of the fastest run, and the wall seconds of its iterations."""
    best = None
    for _ in range(ROUNDS):
        trace = bench.folder / "trace.json"
        out, report = bench.render("scaling", job, "--threads", str(threads), "--trace", str(trace))
        sections = {k: s for k, s in report["threads"]["sections"].items() if not k.startswith(OUTSIDE)}
        wall = sum(s["serial"] + s["loops"] for s in sections.values())
        if best is None or wall < best[1]:
            best = (pieces(json.loads(trace.read_text())), wall, sections, report["machine"]["peak_memory_bytes"])
    return best


def worst_sections(work, threads):
    """The sections that keep `threads` waiting, by their seconds beyond a perfect division."""
    lost = {}
    for section, w in work:
        over = makespan(w, threads) - sum(w) / threads if isinstance(w, list) else w * (1 - 1 / threads)
        lost[section] = lost.get(section, 0) + over
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
    work, wall, _, memory = measured(bench, job, 1)
    work_of_two, two, _, _ = measured(bench, job, 2)
    busy = lambda pieces_: sum(sum(w) for _, w in pieces_ if isinstance(w, list))
    serial = sum(w for _, w in work if not isinstance(w, list))
    more = busy(work_of_two) / max(busy(work), 1e-9)  # seconds of bodies on two threads over those on one
    efficiency = {t: wall / (t * predicted(work, t)) for t in THREADS}
    print(f"{name:36} {serial / wall:7.3f} {wall / two:5.2f} {wall / predicted(work, 2):5.2f} {more:5.2f} | " +
          " ".join(f"{efficiency[t]:.2f}" for t in THREADS[1:]) + f"   {memory / 2**20:.0f} MiB", flush=True)
    for section, seconds in worst_sections(work, 64)[:3]:
        print(f"    {section}: {seconds / predicted(work, 64):.0%} of the time on 64 threads waits for it")
    ratio = predicted(work, 2, more) / two
    bench.figure(f"{name}: predicted / measured time on 2 threads", f"{ratio:.3f}", "within .97 and 1.03",
                 0.97 <= ratio <= 1.03)
    bench.figure(f"{name}: efficiency on 64 threads", f"{efficiency[64]:.2f}", "at least .8 (.6 at 512 x 512)",
                 efficiency[64] >= (0.6 if "small" in name else 0.8))
