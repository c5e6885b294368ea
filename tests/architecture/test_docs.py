"""README and docs/: links and anchors resolve, sizes hold, and what `lacuna` prints stands there as it prints it."""

import os
import pathlib
import re
import subprocess
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "docs/measured"))

import measured  # noqa: E402

LACUNA = pathlib.Path(os.environ.get("LACUNA_BIN", ROOT / "build/release/bin")) / "lacuna"
PAGES = sorted({ROOT / "README.md", *(ROOT / "docs").glob("**/*.md"), *ROOT.glob("*/README.md"), *ROOT.glob("jobs/*/README.md")})
CODE = re.compile(r"`[^`\n]*`|^    .*$", re.MULTILINE)


def anchors(page):
    """Those of its headings, as Markdown viewers make them."""
    headings = re.findall(r"^#+ (.*)$", page.read_text(), re.MULTILINE)
    return [re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings]


def broken_links(page):
    for target in re.findall(r"\]\(([^)\s]+)\)", CODE.sub("", page.read_text())):
        if re.match(r"[a-z]+:", target):
            continue
        name, _, anchor = target.partition("#")
        file = (page.parent / name).resolve() if name else page
        if not file.exists():
            yield f"{page.relative_to(ROOT)}: there is no {target}"
        elif anchor and anchor not in anchors(file):
            yield f"{page.relative_to(ROOT)}: there is no heading {target}"


class Docs(unittest.TestCase):
    def test_links_and_anchors_resolve(self):
        self.assertEqual([broken for page in PAGES for broken in broken_links(page)], [])

    def test_every_page_and_picture_can_be_reached(self):
        linked = {(page.parent / target.partition("#")[0]).resolve() for page in PAGES
                  for target in re.findall(r"\]\(([^)\s]+)\)", page.read_text())}
        files = {*(ROOT / "docs").glob("**/*.md"), *(ROOT / "docs/pictures").glob("*.jpg"), *(ROOT / "docs/pictures").glob("*.png")}
        self.assertEqual(sorted(str(file.relative_to(ROOT)) for file in files - linked), [])

    def test_headings_are_unique(self):
        for page in PAGES:
            found = anchors(page)
            self.assertEqual(sorted(a for a in set(found) if found.count(a) > 1), [], page.name)

    def test_the_first_page_and_the_pages_of_methods_are_short(self):
        limits = {ROOT / "README.md": 130, **{page: 120 for page in (ROOT / "docs/methods").glob("*.md")}}
        self.assertEqual([f"{page.relative_to(ROOT)}: more than {most} lines" for page, most in sorted(limits.items())
                          if len(page.read_text().splitlines()) > most], [])

    def test_pictures_are_small(self):
        self.assertLess(sum(file.stat().st_size for file in (ROOT / "docs/pictures").iterdir()), 1_500_000)

    def test_measured_tables_stand_on_their_pages(self):
        known = {(str(page.relative_to(ROOT)), name) for page in PAGES for name in measured.marks(page)}
        self.assertEqual(known, {(table.page, name) for name, table in measured.TABLES.items()})
        for name, table in measured.TABLES.items():
            self.assertGreater(len(measured.marks(table.page)[name][4].splitlines()), 2, f"{table.page}: no table below {name}")
            if measured.is_stale(name):
                print(f"{table.page}: the code of {name} has changed since it was measured: ./dev docs --measure {name}")

    @unittest.skipUnless(LACUNA.exists(), "lacuna is not built")
    def test_tables_are_those_that_lacuna_prints(self):
        result = subprocess.run([sys.executable, ROOT / "docs/write_tables.py", "--check"], capture_output=True, text=True)
        self.assertEqual((result.returncode, result.stdout), (0, ""), result.stderr)


if __name__ == "__main__":
    result = unittest.main(exit=False).result
    bad = len(result.failures) + len(result.errors)
    print(f"{result.testsRun - bad} passed, {bad} failed")
    sys.exit(bad > 0)
