"""Includes go down the table of folders in docs/architecture.md, and nowhere else."""

import pathlib
import re
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
FLOORS = ("base", "analysis", "renderer", "jobs", "server")


def folders(page):
    """The folders of the table, in its order."""
    return re.findall(r"^\| `([a-z_/]+)` \|", page.read_text(), re.MULTILINE)


def sources(root):
    for floor in FLOORS:
        for kind in ("*.h", "*.cpp"):
            yield from sorted((root / floor).rglob(kind))


def violations(root, order):
    """Includes of a folder that does not stand above the including one, and folders that are in no row."""
    rank = {folder: i for i, folder in enumerate(order)}
    for source in sources(root):
        name, own = source.relative_to(root).as_posix(), source.parent.relative_to(root).as_posix()
        if own not in rank:
            yield f"{own} is not in the table"
            continue
        for included in re.findall(r'^\s*#\s*include\s+"([^"]+)"', source.read_text(), re.MULTILINE):
            folder = pathlib.PurePosixPath(included).parent.as_posix()
            if not (root / included).is_file():
                yield f"{name} includes {included}, which is not there by that path"
            elif folder not in rank or rank[folder] > rank[own]:
                yield f"{name} includes {included}"


class Includes(unittest.TestCase):
    def test_all_go_down_the_table(self):
        self.assertEqual(sorted(set(violations(ROOT, folders(ROOT / "docs/architecture.md")))), [])

    def test_the_table_lists_each_folder_once_and_none_besides(self):
        order = folders(ROOT / "docs/architecture.md")
        self.assertEqual(len(order), len(set(order)))
        there = {source.parent.relative_to(ROOT).as_posix() for source in sources(ROOT)}
        self.assertEqual(sorted(set(order) - there), [])

    def test_upward_includes_circles_and_unknown_folders_are_found(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for name, text in {"analysis/a/x.h": '#include "analysis/b/y.h"\n',  # upward
                               "analysis/b/y.h": '#include "analysis/a/x.h"\n',  # the circle's other half
                               "analysis/b/z.cpp": '  #  include "renderer/c/w.h"\n',
                               "renderer/c/w.h": '#include "y.h"\n',
                               "renderer/d/v.h": ""}.items():
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                (root / name).write_text(text)
            self.assertEqual(sorted(violations(root, ["analysis/a", "analysis/b", "renderer/c"])), [
                "analysis/a/x.h includes analysis/b/y.h",
                "analysis/b/z.cpp includes renderer/c/w.h",
                "renderer/c/w.h includes y.h, which is not there by that path",
                "renderer/d is not in the table"])


class Libraries(unittest.TestCase):
    """Each of these is behind one door, the HTTP library behind two."""

    DOORS = {"httplib.h": {"server/http/http.cpp", "server/http/answer_writer.cpp"},
             "OpenImageIO/": {"renderer/images/module/openimageio.cpp"},
             "embree3/": {"renderer/geometry/rays.cpp"}, "tiny_gltf.h": {"renderer/gltf/gltf_model.cpp"},
             "meshoptimizer.h": {"renderer/gltf/gltf_meshopt.cpp"},
             "boost/": {"jobs/sweep/distributions.cpp"}}

    def test_no_other_source_includes_them(self):
        for header, doors in self.DOORS.items():
            found = {source.relative_to(ROOT).as_posix() for source in sources(ROOT)
                     if re.search(rf"^\s*#\s*include\s+<{header}", source.read_text(), re.MULTILINE)}
            self.assertEqual(found, doors, header)


if __name__ == "__main__":
    result = unittest.main(exit=False).result
    bad = len(result.failures) + len(result.errors)
    print(f"{result.testsRun - bad} passed, {bad} failed")
    sys.exit(bad > 0)
