"""Programs of ours, run for the harness."""

import json
import os
import pathlib
import signal
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[3]
BIN = ROOT / "build/release/bin"


class Failed(Exception):
    """A program that did not do what it was started for; `code` is its exit code."""

    def __init__(self, text, code=1):
        super().__init__(text)
        self.code = code


def call(program, *arguments, may_fail=False):
    """What a program prints, and its exit code. An interrupt is left to it, so that a sweep ends with a checkpoint."""
    with subprocess.Popen([program, *map(str, arguments)], cwd=ROOT, stdout=subprocess.PIPE, text=True) as child:
        handlers = {signal.SIGINT: lambda *_: None, signal.SIGTERM: lambda *_: child.terminate()}
        before = {number: signal.signal(number, handler) for number, handler in handlers.items()}
        try:
            out = child.communicate()[0]
        finally:
            for number, handler in before.items():
                signal.signal(number, handler)
    code = child.returncode if child.returncode >= 0 else 128 - child.returncode
    if code != 0 and not may_fail:
        raise Failed(f"{pathlib.Path(program).name} {arguments[0] if arguments else ''} ended with {code}", code)
    return out, code


def lacuna(*arguments, may_fail=False):
    return call(BIN / "lacuna", *arguments, may_fail=may_fail)


def lacuna_json(*arguments):
    return json.loads(lacuna(*arguments, "--json")[0])


def build(targets):
    """Builds what is measured; what the compiler says goes to stderr."""
    done = subprocess.run([ROOT / "dev", "build", "release", *targets], cwd=ROOT, stdout=sys.stderr, check=False)
    if done.returncode != 0:
        raise Failed("the build failed", done.returncode)


def machine():
    """The processor and what it does now, in words."""
    lines = pathlib.Path("/proc/cpuinfo").read_text().splitlines()
    name = next((line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")), "unknown processor")
    return f"{name}, {os.cpu_count()} threads, load {os.getloadavg()[0]:.1f} at the start"
