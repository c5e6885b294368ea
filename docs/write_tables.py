"""Writes the parts of the pages here that `lacuna` prints from its tables, or with --check tells whether they agree."""

import os
import pathlib
import re
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
LACUNA = pathlib.Path(os.environ.get("LACUNA_BIN", HERE.parent / "build/release/bin")) / "lacuna"
MARK = re.compile(r"^<!-- What follows is printed by `lacuna ([a-z -]+)`; \./dev docs writes it anew\. -->\n\n", re.MULTILINE)
PAGES = ("job-file.md", "sweeps-and-reports.md", "service.md", "scenes.md", "figures.md")


def expected(page):
    """The page as it should be: all up to the mark, then what the command prints, without its title."""
    text = (HERE / page).read_text()
    mark = MARK.search(text)
    printed = subprocess.run([LACUNA, *mark[1].split()], capture_output=True, text=True, check=True).stdout
    body = re.sub(r"\A# .*\n\n", "", printed)
    return text[:mark.end()] + re.sub(r"^## ", "### ", body, flags=re.MULTILINE)


def main():
    check = sys.argv[1:] == ["--check"]
    stale = [page for page in PAGES if (HERE / page).read_text() != expected(page)]
    for page in stale:
        print(f"docs/{page} is not what lacuna prints: ./dev docs" if check else f"docs/{page} written")
        if not check:
            (HERE / page).write_text(expected(page))
    return 1 if check and stale else 0


if __name__ == "__main__":
    sys.exit(main())
