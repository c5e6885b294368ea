"""A planted fault, and the tests that may notice it."""

from typing import NamedTuple

# Tests of the renderer, in two stages: those that are quick to build and to run first.
RENDERER = ("test_core test_materials test_scene test_emitters test_path test_guides test_connections test_visibility "
            "test_film", "test_renderer")


class Fault(NamedTuple):
    name: str
    file: str  # from the top of the tree
    old: str  # stands there once
    new: str
    # Stages, run in this order until a test fails. Each is a list of programs of the unit tests (test_core) and of
    # files for Node (tests/web/list.test.mjs), separated by blanks.
    tests: tuple[str, ...] = RENDERER
