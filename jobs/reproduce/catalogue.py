"""Everything that the papers claim of their methods, and what is compared beside it."""

import kol
import kol_front
import nabata
import noel_clusters
import noel_connections
import noel_guides
import noel_mapping
import noel_regions
import noel_shadows
import noel_shape
import popov
import references

MODULES = (references, noel_shape, noel_shadows, noel_clusters, noel_guides, noel_regions, noel_mapping, noel_connections, popov,
           nabata, kol, kol_front)
ENTRIES = tuple(entry for module in MODULES for entry in module.ENTRIES)


def find(name):
    """The entry of this name, which may be written with _ for -; None if there is none."""
    wanted = name.replace("_", "-")
    return next((e for e in ENTRIES if e.name == wanted), None)
