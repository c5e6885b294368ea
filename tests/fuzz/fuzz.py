"""Runs the fuzz targets of build/fuzz: each for so many seconds, from its seeds; or with --replay those of build/release
on their seeds alone, as they are. Exit code 1: a finding. It is kept
below build/fuzz/findings and tried again first in every run; `build/fuzz/bin/fuzz_TARGET FILE` repeats it. Once it is
mended, a small one belongs into tests/fuzz/corpus."""

import argparse
import concurrent.futures
import dataclasses
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = ROOT / "build/fuzz"


@dataclasses.dataclass(frozen=True)
class Target:
    """A program and the bounds an input must keep: beyond them it is a finding, as a crash or a leak is."""
    name: str
    max_bytes: int      # of an input
    max_mb: int         # of memory, the sanitizers' own included
    seeds: tuple = ()   # beside tests/fuzz/corpus/NAME: files of the project, as far as they are small enough
    schema_words: bool = False  # of the job schema, as a dictionary
    max_malloc_mb: int = 0      # of one allocation, where that may be larger than what is ever touched


TARGETS = (
    Target("job_json", 4096, 512, ("jobs/examples/*.json",), schema_words=True),
    # Thousands of small allocations an input: the sanitizer keeps 256 MB of what was freed, whatever its size.
    Target("sweep_json", 4096, 1024, ("jobs/examples/sweep.json",), schema_words=True),
    Target("documents", 2048, 512),
    Target("http", 4096, 1024),
    Target("glb", 16384, 1024, ("jobs/scenes/*.glb",)),
    Target("checkpoint", 2048, 512),
    Target("cache_entry", 2048, 512),
    # A size is believed, without being touched, until pixels lack: 32768 x 32768 x 4 floats.
    Target("float_image", 4096, 1024, max_malloc_mb=20000),
    Target("texture", 4096, 1024),
    Target("pbrt", 4096, 1024),
    Target("mitsuba", 4096, 1024),
    Target("mesh_file", 4096, 1024),
    Target("picture_file", 4096, 1024),
)
SECONDS_PER_INPUT = 60  # against hangs only: the machine may be busy


def words(schema):
    """Every key and name of a JSON schema."""
    if isinstance(schema, list):
        return set().union(*map(words, schema)) if schema else set()
    if not isinstance(schema, dict):
        return set()
    found = set(schema.get("properties", {}))
    found |= {w for w in [*schema.get("enum", []), schema.get("const")] if isinstance(w, str)}
    return found.union(*map(words, schema.values()))


def dictionary(folder):
    """A libFuzzer dictionary of the job file, made from its schema."""
    command = ROOT / "build/release/bin/lacuna"
    if not command.exists():
        return []
    schema = json.loads(subprocess.run([command, "schema"], capture_output=True, check=True).stdout)
    file = pathlib.Path(folder) / "words.dict"
    file.write_text("".join(f'"\\"{w}\\""\n' for w in sorted(words(schema)) if re.fullmatch(r"\w+", w)))
    return [f"-dict={file}"]


def environment(folder):
    asan = ["detect_stack_use_after_return=1"]
    if symbolizer := shutil.which("llvm-symbolizer-14") or shutil.which("llvm-symbolizer"):
        asan.append(f"external_symbolizer_path={symbolizer}")
    return {**os.environ, "TMPDIR": str(folder), "ASAN_OPTIONS": ":".join(asan),
            "UBSAN_OPTIONS": "print_stacktrace=1", "LSAN_OPTIONS": f"suppressions={ROOT}/tests/soak/lsan.txt"}


def seed_folders(target, folder, grow):
    """The corpus that new inputs go to, then those that are only read."""
    new = BUILD / "corpus" / target.name if grow else pathlib.Path(folder) / "corpus"
    new.mkdir(parents=True, exist_ok=True)
    own = pathlib.Path(folder) / "seeds"
    own.mkdir()
    for pattern in target.seeds:
        for file in ROOT.glob(pattern):
            if file.stat().st_size <= target.max_bytes:
                shutil.copy(file, own)
    found = BUILD / "findings" / target.name
    found.mkdir(parents=True, exist_ok=True)
    return [new, own, *(p for p in [ROOT / "tests/fuzz/corpus" / target.name, found] if p.is_dir())]


def summary(log, seconds):
    """What libFuzzer says of a run in one line."""
    covered = re.findall(r"cov: (\d+) ft: (\d+)", log)
    stat = dict(re.findall(r"stat::(\w+):\s+(\d+)", log))
    growth = f"{covered[0][0]} -> {covered[-1][0]} edges" if covered else "no coverage"
    return (f"{int(stat.get('number_of_executed_units', 0)):>9} executions in {seconds:.0f} s, {growth}, "
            f"{stat.get('peak_rss_mb', '?')} MB")


def run(target, seconds, grow):
    """True: no finding."""
    memory = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None
    with tempfile.TemporaryDirectory(prefix="lacuna-fuzz-", dir=memory) as folder:
        folders = seed_folders(target, folder, grow)
        findings = BUILD / "findings" / target.name
        before = set(findings.iterdir())
        command = [
            BUILD / f"bin/fuzz_{target.name}", f"-max_total_time={seconds}", f"-max_len={target.max_bytes}",
            f"-timeout={SECONDS_PER_INPUT}", f"-report_slow_units={SECONDS_PER_INPUT}",
            f"-rss_limit_mb={target.max_mb}", f"-malloc_limit_mb={target.max_malloc_mb or target.max_mb}",
            f"-artifact_prefix={findings}/", "-print_final_stats=1",
            *(dictionary(folder) if target.schema_words else []), *folders]
        started = time.monotonic()
        log_file = BUILD / f"{target.name}.log"
        with open(log_file, "wb") as out:
            try:
                passed = subprocess.run(command, env=environment(folder), stdout=out, stderr=out,
                                        timeout=seconds + 20 * SECONDS_PER_INPUT, check=False).returncode == 0
            except subprocess.TimeoutExpired:
                passed = False
                out.write(b"\nnever came to its end\n")
        log = log_file.read_text(errors="replace")
        print(f"{target.name:<12} {'passed' if passed else 'FAILED'} {summary(log, time.monotonic() - started)}",
              flush=True)
        if not passed:
            print(log[-6000:], flush=True)
            for file in sorted(set(findings.iterdir()) - before):
                print(f"kept: {file.relative_to(ROOT)}", flush=True)
        return passed


def replay(target):
    """The seeds and what was found before, in a build without libFuzzer. True: no finding."""
    with tempfile.TemporaryDirectory(prefix="lacuna-fuzz-") as folder:
        own = [f for pattern in target.seeds for f in ROOT.glob(pattern) if f.stat().st_size <= target.max_bytes]
        kept = [f for f in (ROOT / "tests/fuzz/corpus" / target.name).glob("*") if f.is_file()]
        files = sorted(own + kept) or [os.devnull]  # nothing is an input, too
        done = subprocess.run([ROOT / "build/release/tests/replay", target.name, *files], capture_output=True, text=True,
                              env={**os.environ, "TMPDIR": folder}, timeout=20 * SECONDS_PER_INPUT, check=False)
    passed = done.returncode == 0
    print(f"{target.name:<12} {'passed' if passed else 'FAILED'} {len(files)} inputs", flush=True)
    if not passed:
        print("\n".join(done.stdout.splitlines()[-1:]), done.stderr[-6000:], sep="\n", flush=True)
    return passed


def main():
    names = [t.name for t in TARGETS]
    parser = argparse.ArgumentParser(prog="fuzz.py", description=__doc__)
    parser.add_argument("targets", nargs="*", metavar="TARGET", help=f"of {', '.join(names)} (default: all)")
    parser.add_argument("--seconds", type=int, default=10, help="for each target (default: %(default)s)")
    parser.add_argument("--grow", action="store_true",
                        help="keep inputs that reach new code in build/fuzz/corpus, and begin with them")
    parser.add_argument("--replay", action="store_true", help="the seeds alone, by the program of build/release")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="targets at a time")
    asked = parser.parse_args()
    if unknown := set(asked.targets) - set(names):
        parser.error(f"no target {min(unknown)}; there are {', '.join(names)}")
    chosen = [t for t in TARGETS if not asked.targets or t.name in asked.targets]
    if not asked.replay and (missing := [t.name for t in chosen if not (BUILD / f"bin/fuzz_{t.name}").exists()]):
        sys.exit(f"build/fuzz has no {', '.join(missing)}: ./dev build fuzz fuzz")
    with concurrent.futures.ThreadPoolExecutor(asked.jobs) as pool:
        results = list(pool.map(lambda t: replay(t) if asked.replay else run(t, asked.seconds, asked.grow), chosen))
    print(f"{sum(results)} passed, {len(results) - sum(results)} failed")
    return 0 if all(results) else 1


if __name__ == "__main__":
    sys.exit(main())
