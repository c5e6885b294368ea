"""Everything that the three papers claim of their methods, and what is compared beside it."""

from harness import kol, nabata, noel_paths, noel_shape, noel_shadows, references

ENTRIES = (*references.ENTRIES, *noel_shape.ENTRIES, *noel_shadows.ENTRIES, *noel_paths.ENTRIES, *nabata.ENTRIES,
           *kol.ENTRIES)


def find(name):
    """The entry of this name, which may be written with _ for -; None if there is none."""
    wanted = name.replace("_", "-")
    return next((e for e in ENTRIES if e.name == wanted), None)
