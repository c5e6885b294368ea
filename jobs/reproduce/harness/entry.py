"""An entry of the catalogue: one table or figure of a paper."""

import dataclasses
import importlib
import pathlib

SCRIPTS = pathlib.Path(__file__).resolve().parents[1]


@dataclasses.dataclass(frozen=True)
class Entry:
    """`text` says in one line what is compared, `needs` which methods of ours. It is built if there is a script of its
    name beside the harness (README.md)."""

    name: str
    source: str
    text: str
    needs: str
    claims: tuple = ()

    @property
    def script(self):
        return SCRIPTS / (self.name.replace("-", "_") + ".py")

    @property
    def built(self):
        return self.script.is_file()

    def module(self):
        return importlib.import_module(self.script.stem)

    def figures(self):
        """The paper's numbers in one line."""
        return "; ".join(f"{c.quantity} {c}" for c in self.claims if c.figure is not None)
