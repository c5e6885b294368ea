"""Everything that the papers claim of their methods, and what is compared beside it."""

import kol
import nabata
import noel_connections
import noel_guides
import noel_regions
import noel_shadows
import noel_shape
import popov
import references

ENTRIES = (*references.ENTRIES, *noel_shape.ENTRIES, *noel_shadows.ENTRIES, *noel_guides.ENTRIES,
           *noel_regions.ENTRIES, *noel_connections.ENTRIES, *popov.ENTRIES, *nabata.ENTRIES, *kol.ENTRIES)


def find(name):
    """The entry of this name, which may be written with _ for -; None if there is none."""
    wanted = name.replace("_", "-")
    return next((e for e in ENTRIES if e.name == wanted), None)
