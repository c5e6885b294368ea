"""Do the 95 % intervals of `lacuna report` hold the truth in about 95 of 100 sweeps? A hundred small sweeps of the same
two cells with other seeds; the truth is the mean over all of their runs."""

import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
LACUNA = ROOT / "build/release/bin/lacuna"
SEEDS = 3
TOO_FEW = 1e-3  # probability of so few hits, if the intervals are right

SECONDS, ERROR = 0.2, 0.002  # where runs are compared: in the middle of their curves


def sweep(seed):
    """Of cornell.glb; budgets are CPU seconds, which suffer less from what else the machine does."""
    return {
        "job": {"scene": "cornell.glb", "resolution": [32, 32], "reference": "auto", "threads": 1, "seed": seed,
                "reference_iterations": 20000, "budget": {"cpu_seconds": 0.4}},
        "axes": {"/integrator/roulette_depth": [2, 8]}, "seeds": SEEDS, "baseline": {"/integrator/roulette_depth": 8},
        "compare_at": {"seconds": [SECONDS], "clock": "cpu_seconds", "errors": [ERROR]},
    }


def report(folder, seed):
    file = folder / f"{seed}.json"
    file.write_text(json.dumps(sweep(seed)))
    subprocess.run([LACUNA, "sweep", file, "--quiet", "-o", folder / f"{seed}.sweep"], check=True)
    done = subprocess.run([LACUNA, "report", folder / f"{seed}.sweep", "--json"], check=True, capture_output=True, text=True)
    return json.loads(done.stdout)


def quantities(answers):
    """Every estimate of a report by name; what was not reached by all runs is left out."""
    for cell in answers["cells"]:
        name = f"roulette from {cell['settings']['/integrator/roulette_depth']}"
        yield f"error at {SECONDS} s, {name}", cell["at"][0]["error"]
        yield f"time to {ERROR}, {name}", cell["to"][0]["time"]
        yield f"efficiency, {name}", cell["efficiency"]
        yield f"bias squared, {name}", cell["bias_squared"]
        yield f"bias between runs, {name}", cell["bias_between_runs"]
        yield f"error gain, {name}", cell["at"][0]["gain"]
        yield f"speed-up, {name}", cell["to"][0]["speed_up"]


def truth(name, estimates):
    """Path tracing has no bias; means are geometric, as those of a report."""
    if name.startswith("bias"):
        return 0
    return math.exp(sum(math.log(e["value"]) for e in estimates) / len(estimates))


def probability_of_so_few(hits, trials, share):
    return sum(math.comb(trials, k) * share**k * (1 - share)**(trials - k) for k in range(hits + 1))


def main():
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 100
    found = {}
    with tempfile.TemporaryDirectory(prefix="lacuna-intervals-") as folder:
        os.environ["LACUNA_DATA"] = folder
        for k in range(count):
            for name, estimate in quantities(report(pathlib.Path(folder), 1 + SEEDS * k)):
                if estimate and "low" in estimate:
                    found.setdefault(name, []).append(estimate)
            print(f"\r{k + 1} of {count} sweeps", end="", file=sys.stderr, flush=True)
    print(file=sys.stderr)
    failed = 0
    for name, estimates in found.items():
        true = truth(name, estimates)
        hits = sum(e["low"] <= true <= e["high"] for e in estimates)
        good = len(estimates) >= count / 2 and probability_of_so_few(hits, len(estimates), 0.95) >= TOO_FEW
        failed += not good
        print(f"{'ok' if good else 'FAILED':<7}{name:<36} {hits:>4} of {len(estimates):>4} hold {true:.4g}")
    print(f"{len(found) - failed} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
