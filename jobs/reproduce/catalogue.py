"""Everything that the papers claim of their methods, and what is compared beside it."""

import kol
import kol_front
import kol_lights
import kol_systems
import nabata
import noel_clusters
import noel_connections
import noel_distributions
import noel_gates
import noel_guides
import noel_mapping
import noel_node_maps
import noel_overlays
import noel_portals
import noel_regions
import noel_shadows
import noel_shape
import noel_stand_ins
import noel_systems
import popov
import references

MODULES = (references, noel_shape, noel_overlays, noel_shadows, noel_gates, noel_node_maps, noel_clusters, noel_guides, noel_regions,
           noel_portals, noel_mapping, noel_connections, noel_stand_ins, noel_distributions, noel_systems, popov, nabata, kol, kol_lights,
           kol_systems, kol_front)
ENTRIES = tuple(entry for module in MODULES for entry in module.ENTRIES)


def find(name):
    """The entry of this name, which may be written with _ for -; None if there is none."""
    wanted = name.replace("_", "-")
    return next((e for e in ENTRIES if e.name == wanted), None)
