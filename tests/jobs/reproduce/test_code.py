"""Which code a result depends on."""

import dataclasses
import importlib.util
import pathlib
import tempfile
import unittest
from unittest import mock

from catalogue import ENTRIES, find
from harness import child, code

MODULE = '''
"""A module."""
SEEDS = {"a": 3}
def helper(x):
    return x + 1
def measure(run):
    """What it does."""
    return [helper(s) for s in SEEDS]
'''


class Code(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def of_python(self, text, number=iter(range(100))):
        file = self.folder / f"m{next(number)}.py"  # linecache keeps a file's lines by its name
        file.write_text(text)
        spec = importlib.util.spec_from_file_location("measured", file)
        module = importlib.util.module_from_spec(spec)
        with mock.patch.dict("sys.modules", measured=module), mock.patch.object(code, "SOURCES", self.folder):
            spec.loader.exec_module(module)
            return code.python(module.measure)

    def test_what_a_measurement_names_counts_and_words_do_not(self):
        plain = self.of_python(MODULE)
        for words in (("A module", "One"), ("What it does", "All"), ("x + 1", "x + 1  # more")):
            self.assertEqual(self.of_python(MODULE.replace(*words)), plain, words)
        for change in (("x + 1", "x + 2"), ('"a": 3', '"a": 4'), ("for s in", "for s in 2 *")):
            self.assertNotEqual(self.of_python(MODULE.replace(*change)), plain, change)

    def of_renderer(self, **changes):
        files = {"renderer/integrators/path.cpp": '#include "a.h"\n// words\n', "a.h": "int a();", "a.cpp": '#include "b.h"',
                 "b.h": "int b;", "c.h": "int c;", **{name.replace("_", "."): text for name, text in changes.items()}}
        for name, text in files.items():
            (self.folder / name).parent.mkdir(parents=True, exist_ok=True)
            (self.folder / name).write_text(text)
        code._source.cache_clear(), code._below.cache_clear()
        self.addCleanup(lambda: (code._source.cache_clear(), code._below.cache_clear()))
        with mock.patch.object(child, "ROOT", self.folder):
            return code.renderer(dataclasses.replace(ENTRIES[0], needs="path with nothing"))

    def test_what_an_integrator_includes_counts_and_no_other_source(self):
        plain = self.of_renderer()
        self.assertEqual(self.of_renderer(a_h="int a(); // words", c_h="int other;"), plain)
        self.assertNotEqual(self.of_renderer(a_h="int other();"), plain)
        self.assertNotEqual(self.of_renderer(b_h="int other;"), plain, "by way of the header's body")

    def test_every_entry_names_code_that_is_there(self):
        self.assertEqual([entry.name for entry in ENTRIES if not code.roots(entry)], [])
        self.assertEqual(code.roots(find("noel-fig-23")),
                         ["renderer/integrators/bdpt.cpp", "renderer/integrators/many_lights.cpp"])
