"""Measures the tables of README and the manual again, and writes them into their pages:

    ./dev docs --measure            lists them, with the commit of each and whether its code has changed since
    ./dev docs --measure NAME...    measures these

The line above a table names it: `<!-- ./dev docs --measure NAME: commit 1a2b3c4, code 0123456789abcdef -->`. The code is a hash
of the C++ below the integrators that take part."""

import argparse
import pathlib
import re
import shutil
import sys
import types
from typing import NamedTuple

ROOT = pathlib.Path(__file__).resolve().parents[2]
for folder in ("jobs/reproduce", "tests/bench"):
    sys.path.append(str(ROOT / folder))

import regrets  # noqa: E402
import samplers  # noqa: E402
import which_method  # noqa: E402
from harness import code, identity  # noqa: E402

MARK = re.compile(r"<!-- \./dev docs --measure ([a-z-]+): commit ([^,\n]+), code ([0-9a-f]+|none) -->\n((?:\|.*\n)*)")


class Table(NamedTuple):
    page: str  # from the top of the tree
    minutes: int  # on two cores
    module: types.ModuleType  # lines(folder) renders into a folder and returns the table; INTEGRATORS take part


TABLES = {
    "regret": Table("README.md", 40, regrets),
    "sampler": Table("docs/methods/samplers.md", 10, samplers),
    "which-method": Table("docs/methods/README.md", 25, which_method),
}


def code_of(table):
    return code.renderer(types.SimpleNamespace(needs=" ".join(table.module.INTEGRATORS)))


def marks(page):
    """{name: match} of the measured tables in a page."""
    return {mark[1]: mark for mark in MARK.finditer((ROOT / page).read_text())}


def is_stale(name):
    """Whether the code of a table has changed since it was measured."""
    return marks(TABLES[name].page)[name][3] != code_of(TABLES[name])


def measure(name):
    table = TABLES[name]
    folder = ROOT / "build/measured" / name
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    lines = table.module.lines(folder)
    page = ROOT / table.page
    text, mark = page.read_text(), marks(table.page)[name]
    new = f"<!-- ./dev docs --measure {name}: commit {identity.commit()}, code {code_of(table)} -->\n" + "\n".join(lines) + "\n"
    page.write_text(text[:mark.start()] + new + text[mark.end():])
    print(f"{table.page}: {name} written")


def show():
    for name, table in TABLES.items():
        state = "its code has changed since" if is_stale(name) else "its code is that of the tree"
        print(f"{name:<14} {table.page:<26} about {table.minutes} min   commit {marks(table.page)[name][2]}; {state}")


def main():
    parser = argparse.ArgumentParser(prog="./dev docs --measure", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"of {', '.join(TABLES)}")
    names = parser.parse_args().names
    if unknown := [name for name in names if name not in TABLES]:
        parser.error(f"there is no table {unknown[0]}; allowed: {', '.join(TABLES)}")
    for name in names:
        measure(name)
    if not names:
        show()
