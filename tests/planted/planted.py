"""Plants the faults of faults.py, one at a time, in a copy of the tree: the tests of `./dev test` must turn red."""

import argparse
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

from faults import FAULTS

ROOT = pathlib.Path(__file__).resolve().parents[2]
PATIENCE = 900  # seconds of a test program or file; a fault that makes it hang is noticed, too


def copy_tree(folder):
    """What is tracked, and what is new, as it lies there."""
    names = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=ROOT,
                           check=True, capture_output=True, text=True).stdout.split("\0")
    for name in filter(None, names):
        if (ROOT / name).is_file():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, folder / name)


def problems(faults):
    """Faults whose old text does not stand in its file just once."""
    for fault in faults:
        file = ROOT / fault.file
        count = file.read_text().count(fault.old) if file.is_file() else 0
        if count != 1:
            yield f'"{fault.name}": its old text stands {count} times in {fault.file}, must be once: {fault.old!r}'


def is_node(test):
    return test.endswith(".mjs")


def targets_of(test):
    """What must be built for a test."""
    if not is_node(test):
        return [test]
    return ["lacuna"] if test.startswith("tests/jobs/") else ["lacuna", "lacuna-server"]


class Copy:
    """A copy of the tree that is built again and again."""

    def __init__(self, folder, jobs):
        self.folder, self.jobs = folder, jobs
        copy_tree(folder)
        (folder / "build/release").mkdir(parents=True)
        self.must("configure", ["cmake", "--preset", "release"])
        # The browser driver, which the copy lacks since git ignores it.
        driver = ROOT / "tests/web/node_modules"
        if driver.is_dir():
            (folder / "tests/web/node_modules").symlink_to(driver)

    def call(self, command, **options):
        return subprocess.run(command, cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                              errors="replace", **options, check=False)

    def must(self, what, command):
        done = self.call(command)
        if done.returncode != 0:
            raise RuntimeError(f"{what} failed:\n{done.stdout[-4000:]}")

    def first_red(self, stages):
        """The first test of these stages that fails, after building what each takes; None: all pass."""
        for tests in map(str.split, stages):
            targets = sorted({target for test in tests for target in targets_of(test)})
            self.must("the build", ["cmake", "--build", "--preset", "release", "-j", str(self.jobs), "--target",
                                    *targets])
            for test in tests:
                red = self.run_node(test) if is_node(test) else self.run_program(test)
                if red:
                    return red
        return None

    def run_program(self, program):
        environment = {**os.environ, "GTEST_FAIL_FAST": "1"}
        try:
            done = self.call([str(self.folder / "build/release/tests" / program), "--gtest_filter=-Long*"], env=environment,
                             timeout=PATIENCE)
        except subprocess.TimeoutExpired:
            return f"{program} (did not end)"
        if done.returncode == 0:
            return None
        failed = re.search(r"\[  FAILED  \] (\S+?),? ", done.stdout)
        return f"{program} {failed[1] if failed else '(crashed)'}"

    def run_node(self, file):
        try:
            done = self.call(["node", "--test", "--test-reporter=tap", file], timeout=PATIENCE)
        except subprocess.TimeoutExpired:
            return f"{file} (did not end)"
        if done.returncode == 0:
            return None
        failed = re.search(r"^ *not ok \d+ - (.*)", done.stdout, re.MULTILINE)
        return f"{file}: {failed[1] if failed else '(crashed)'}"

    def plant(self, fault):
        file = self.folder / fault.file
        sound = file.read_text()
        file.write_text(sound.replace(fault.old, fault.new))
        try:
            return self.first_red(fault.tests)
        finally:
            file.write_text(sound)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("words", nargs="*", help="only faults whose name or file holds one of these")
    parser.add_argument("--list", action="store_true", help="only check that all can be planted")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="of the build (default: %(default)s)")
    asked = parser.parse_args()
    faults = [f for f in FAULTS if not asked.words or any(w in f.name or w in f.file for w in asked.words)]
    if wrong := list(problems(faults)):
        sys.exit("\n".join(wrong))
    if asked.list:
        print("\n".join(f"{f.file}: {f.name}" for f in faults))
        return 0
    survived = 0
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))  # the copy goes with us
    with tempfile.TemporaryDirectory(prefix="lacuna-planted-") as folder:
        copy = Copy(pathlib.Path(folder), asked.jobs)
        stages = list(dict.fromkeys(stage for fault in faults for stage in fault.tests))
        if red := copy.first_red(stages):
            sys.exit(f"without any fault {red} is red")
        for fault in faults:
            begin = time.monotonic()
            red = copy.plant(fault)
            survived += red is None
            print(f"{'caught  ' if red else 'SURVIVED'} {fault.name}: {red or fault.file}"
                  f" ({time.monotonic() - begin:.0f} s)", flush=True)
    print(f"{len(faults) - survived} faults caught, {survived} survived")
    return 1 if survived else 0


if __name__ == "__main__":
    sys.exit(main())
