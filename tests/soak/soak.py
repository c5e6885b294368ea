"""Long checks: many kills and resumes, faults of the machine, all tests under sanitizers, fuzzing, whether intervals hold the
truth, whether the tests notice faults, and the service on a real Slurm."""

import argparse
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]


def run(name, command, **environment):
    print(f"== {name}", flush=True)
    done = subprocess.run(command, cwd=ROOT, env={**os.environ, **environment}, check=False)
    print(f"== {name}: {'passed' if done.returncode == 0 else 'FAILED'}", flush=True)
    return done.returncode == 0


def kills(count):
    return run(f"{count} kills at any moment, resumed to the same bits",
               ["node", "--test", "tests/jobs/cli/kill.test.mjs"], LACUNA_KILLS=str(count))


def service(count):
    return run(f"the service killed {count} times, and a disk that fills up",
               ["node", "--test", "tests/soak/service_kills.test.mjs"], LACUNA_KILLS=str(count))


def sanitizers(preset, options):
    """All test programs under a sanitizer preset."""
    if not run(f"{preset}: build", ["./dev", "build", preset]):
        return False
    programs = sorted((ROOT / f"build/{preset}/tests").glob("test_*"))
    results = [run(f"{preset}: {program.name}", [str(program), "--gtest_brief=1"], **options)
               for program in programs if os.access(program, os.X_OK)]
    return bool(results) and all(results)


def long_tests():
    """The tests that `./dev test` has no time for."""
    programs = sorted((ROOT / "build/release/tests").glob("test_*"))
    results = [run(f"long tests: {program.name}", [str(program), "--gtest_brief=1", "--gtest_filter=Long*"])
               for program in programs if os.access(program, os.X_OK)]
    return bool(results) and all(results)


def fuzz(seconds):
    """Every fuzz target, going on from the corpus that earlier runs found; findings: build/fuzz/findings."""
    return (run("fuzz: build", ["./dev", "build", "fuzz", "fuzz"])
            and run(f"fuzz: {seconds} s for each target",
                    ["python3", "tests/fuzz/fuzz.py", "--grow", "--seconds", str(seconds)]))


def slurm(count):
    return run(f"Slurm on this machine, {count} kills of renderers, of slurmd and of the service",
               [sys.executable, "tests/soak/slurm.py"], LACUNA_KILLS=str(count))


CHECKS = {
    "stops": lambda _: run("seconds from SIGTERM to the end of a busy job", [sys.executable, "tests/soak/stops.py"]),
    "kills": lambda _: kills(20),
    "service": lambda _: service(300),
    "faults": lambda _: run("faults of the machine, which cost no job", ["node", "tests/soak/faults.mjs"]),
    "long": lambda _: long_tests(),
    "asan": lambda _: sanitizers("asan", {
        "LSAN_OPTIONS": f"suppressions={ROOT}/tests/soak/lsan.txt",
    }),
    "tsan": lambda _: sanitizers("tsan", {
        "TSAN_OPTIONS": f"suppressions={ROOT}/tests/soak/tsan.txt",
    }),
    "intervals": lambda _: run("intervals of a hundred sweeps", [sys.executable, "tests/soak/intervals.py"]),
    "planted": lambda _: run("planted faults", [sys.executable, "tests/planted/planted.py"]),
    "fuzz": lambda asked: fuzz(asked.seconds),
    "slurm": lambda asked: slurm(asked.kills),
}


def main():
    parser = argparse.ArgumentParser(prog="./dev soak", description=__doc__)
    parser.add_argument("checks", nargs="*", metavar="CHECK", help=f"of {', '.join(CHECKS)} (default: all)")
    parser.add_argument("--seconds", type=int, default=600, help="of fuzzing, for each target (default: %(default)s)")
    parser.add_argument("--kills", type=int, default=20,
                        help="on Slurm, of renderers, of slurmd and of the service each (default: %(default)s)")
    asked = parser.parse_args()
    chosen = asked.checks or list(CHECKS)
    if unknown := [c for c in chosen if c not in CHECKS]:
        parser.error(f"no check {unknown[0]}; there are {', '.join(CHECKS)}")
    results = {c: CHECKS[c](asked) for c in chosen}
    for name, passed in results.items():
        print(f"{name:<8} {'passed' if passed else 'FAILED'}")
    print(f"{sum(results.values())} passed, {len(results) - sum(results.values())} failed")
    return 0 if all(results.values()) else 1


if __name__ == "__main__":
    sys.exit(main())
