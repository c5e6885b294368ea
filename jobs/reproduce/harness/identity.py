"""What a result depends on: the job, the programs and the files that the job names. A result is used again only while all
of these are the same."""

import functools
import hashlib
import json
import os
import pathlib
import subprocess

from harness import child


@functools.lru_cache(maxsize=None)
def _hash(path, _size, _modified):
    with open(path, "rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def file_hash(path):
    """SHA-256 of a file's bytes; computed again when its size or its time of change is another."""
    stat = os.stat(path)
    return _hash(str(path), stat.st_size, stat.st_mtime_ns)


def programs(targets):
    """The hashes of these programs, with the module that `lacuna` loads."""
    files = [child.BIN / target for target in targets]
    if "lacuna" in targets:
        files += sorted(child.BIN.glob("lacuna-*.so"))
    return {file.name: file_hash(file) for file in files}


def scene_file(name):
    """The file of this name below the first of the scenes roots that has it; None: there is none."""
    for root in filter(None, os.environ.get("LACUNA_SCENES", "").split(":")):
        file = pathlib.Path(root) / name
        if name and file.is_file():
            return file
    return None


def files_named(value):
    """Every string of a job or a sweep that is a file below a scenes root, with its hash. A scene of several files
    counts with all that lie in its folder."""
    if isinstance(value, dict):
        value = list(value.values())
    if isinstance(value, list):
        return {name: digest for part in value for name, digest in files_named(part).items()}
    file = scene_file(value) if isinstance(value, str) and len(value) < 1024 else None
    if file is None:
        return {}
    found = {value: file_hash(file)}
    if file.suffix == ".gltf":
        found |= {str(pathlib.Path(value).parent / other.name): file_hash(other)
                  for other in sorted(file.parent.iterdir()) if other.is_file()}
    return found


def key(*parts):
    """Twelve digits that stand for these values."""
    return hashlib.sha256(json.dumps(parts, sort_keys=True).encode()).hexdigest()[:12]


@functools.lru_cache(maxsize=None)
def commit():
    """That of the tree, as "1a2b3c4", or "1a2b3c4 with changes"; "no commit" outside a repository."""
    def git(*arguments):
        return subprocess.run(["git", *arguments], cwd=child.ROOT, capture_output=True, text=True, check=False).stdout.strip()

    name = git("rev-parse", "--short=7", "HEAD")
    changes = git("status", "--porcelain", "--untracked-files=no", "--", ".", ":!docs") if name else ""
    return f"{name or 'no commit'}{' with changes' if changes else ''}"
