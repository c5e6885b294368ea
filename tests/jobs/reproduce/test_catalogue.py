"""The list of what the papers claim, and the sweeps of what is built."""

import json
import os
import pathlib
import re
import tempfile
import unittest

from catalogue import ENTRIES, find
from harness import child

BUILT = [entry for entry in ENTRIES if entry.built]


class Catalogue(unittest.TestCase):
    def test_names_tell_entries_apart(self):
        names = [entry.name for entry in ENTRIES]
        self.assertEqual(len(set(names)), len(names))
        for entry in ENTRIES:
            self.assertRegex(entry.name, r"^(noel|nabata|kol|popov|path)-[a-z0-9-]+$")
            self.assertIs(find(entry.name), entry)
            self.assertIs(find(entry.name.replace("-", "_")), entry)
            self.assertTrue(entry.source and entry.text and entry.needs, entry.name)
        self.assertIsNone(find("noel-table-7"))

    def test_every_table_of_the_papers_is_there(self):
        names = {entry.name for entry in ENTRIES}
        self.assertLessEqual({f"noel-table-{n}" for n in range(1, 7)}, names)
        self.assertLessEqual({"noel-fig-77", "nabata-table-1-2", "kol-fig-10"}, names)

    def test_claims_are_told_apart_and_their_figures_have_bounds_that_allow_them(self):
        for entry in ENTRIES:
            quantities = [claim.quantity for claim in entry.claims]
            self.assertEqual(len(set(quantities)), len(quantities), entry.name)
            for claim in entry.claims:
                if claim.figure is not None:
                    self.assertTrue(claim.judged and claim.low <= claim.figure <= claim.high, (entry.name, claim))

    def test_every_module_of_a_paper_is_in_the_catalogue(self):
        modules = {p.stem for p in (child.ROOT / "jobs/reproduce").glob("*.py")} - {"__main__", "catalogue"}
        self.assertEqual({entry.measure.__module__ for entry in BUILT}, modules)


class Sweeps(unittest.TestCase):
    def test_sweeps_of_what_is_built_are_valid(self):
        swept = [entry for entry in BUILT if entry.sweep]
        self.assertTrue(swept)
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "sweep.json"
            for entry in swept:
                for full in (False, True):
                    sweep = entry.sweep(full)
                    file.write_text(json.dumps(sweep))
                    listed = child.lacuna("sweep", file, "--list")[0].splitlines()[1:]
                    self.assertTrue(listed, entry.name)
                    self.assertEqual(len(listed) % sweep["seeds"], 0)
                    self.assertTrue(all(re.match(r" +\d+ \d{4}-\d+ +queued ", line) for line in listed), listed)
            self.assertEqual(os.listdir(folder), ["sweep.json"])
