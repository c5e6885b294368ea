"""An entry of the catalogue: one table or figure of a paper."""

import dataclasses


@dataclasses.dataclass(frozen=True)
class Entry:
    """`text` says in one line what is compared, `needs` which methods of ours; README.md tells the rest."""

    name: str
    source: str
    text: str
    needs: str
    claims: tuple = ()
    measure: object = None
    sweep: object = None
    targets: tuple = ("lacuna",)

    @property
    def built(self):
        return self.measure is not None

    def figures(self):
        """The paper's numbers in one line."""
        return "; ".join(f"{c.quantity} {c}" for c in self.claims if c.figure is not None)


class Entries(list):
    """The entries of a paper. Arguments are those of Entry."""

    def planned(self, *arguments):
        """What is claimed and not built yet."""
        self.append(Entry(*arguments))

    def measured(self, *arguments, **more):
        """Decorates the function that measures it."""
        def add(measure):
            self.append(Entry(*arguments, **more, measure=measure))
            return measure
        return add
