"""The code that a result depends on, as two hashes: the C++ below the integrators that an entry needs, by their includes, and
the Python that measures it, by what its function names. Comments, docstrings and what the harness does besides are in neither:
they change no number."""

import ast
import functools
import inspect
import pathlib
import re
import textwrap
import types

from harness import child, identity

SOURCES = pathlib.Path(__file__).resolve().parents[1]
INTEGRATORS = {"photon_map": "photon_mapping", "sppm": "photon_mapping", "vcm": "photon_mapping"}  # others by their name
PROGRAMS = {"analysis": ["analysis/space_analysis/space_analysis.h"]}  # what an entry needs besides integrators


def roots(entry):
    """The sources that do what an entry's `needs` names."""
    found = []
    for word in re.findall(r"[a-z_]+", entry.needs):
        file = f"renderer/integrators/{INTEGRATORS.get(word, word)}.cpp"
        found += PROGRAMS.get(word) or ([file] if (child.ROOT / file).is_file() else [])
    return sorted(set(found))


@functools.lru_cache(maxsize=None)
def _source(name):
    """Of a source its text without comments and spaces, and what it includes of ours; a header counts with its body."""
    text = (child.ROOT / name).read_text()
    included = re.findall(r'^\s*#\s*include\s+"([^"]+)"', text, re.MULTILINE)
    body = pathlib.PurePosixPath(name).with_suffix(".cpp").as_posix()
    beside = [body] if name.endswith(".h") and (child.ROOT / body).is_file() else []
    return re.sub(r"//.*|\s+", "", text), [*included, *beside]


@functools.lru_cache(maxsize=None)
def _below(name):
    """A source with all that it includes, however deep."""
    seen, left = set(), [name]
    while left:
        if (file := left.pop()) not in seen:
            seen.add(file)
            left += _source(file)[1]
    return frozenset(seen)


def renderer(entry):
    files = set().union(*map(_below, roots(entry)))
    return identity.key([(file, _source(file)[0]) for file in sorted(files)])


def _text(thing):
    """A function or class as Python alone reads it: no comments, decorators or docstrings."""
    tree = ast.parse(textwrap.dedent(inspect.getsource(thing)))
    for node in ast.walk(tree):
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            node.decorator_list = []
            if ast.get_docstring(node) is not None:
                node.body = node.body[1:] or [ast.Pass()]
    return ast.unparse(tree)


def _ours(thing):
    """Whether it is a function, a class or a module of an entry's, not of the harness's own: many_lights measures."""
    file = getattr(inspect.getmodule(thing), "__file__", None) or ""
    return pathlib.Path(file).is_relative_to(SOURCES) and (
        not pathlib.Path(file).is_relative_to(SOURCES / "harness") or file.endswith("many_lights.py"))


def _named(code):
    """Every name in a function, those of functions in it included."""
    return {*code.co_names, *(n for c in code.co_consts if isinstance(c, types.CodeType) for n in _named(c))}


def _bodies(thing):
    return [f for f in vars(thing).values() if isinstance(f, types.FunctionType)] if inspect.isclass(thing) else [thing]


def _values(code, scope):
    """What a function names, with the names of where it stands: of its module, and of our modules that it names."""
    names = sorted(_named(code))
    modules = [scope[n] for n in names if isinstance(scope.get(n), types.ModuleType) and _ours(scope[n])]
    return [(f"{space['__name__']}.{n}", space[n]) for space in (scope, *map(vars, modules)) for n in names if n in space]


def python(measure):
    """Of a function: its text, and those of the functions and the values that it names, however deep."""
    found, left = {}, [measure]
    while left:
        thing = left.pop()
        own = f"{thing.__module__}.{thing.__qualname__}"
        if own in found or not _ours(thing):
            continue
        found[own] = _text(thing)
        for body in _bodies(thing):
            for name, value in _values(body.__code__, body.__globals__):
                if isinstance(value, (types.FunctionType, type)):
                    left.append(value)
                elif isinstance(value, (str, int, float, tuple, list, set, dict)):
                    text = repr(sorted(value) if isinstance(value, set) else value)
                    found |= {} if "Claim(" in text else {name: re.sub(r" at 0x[0-9a-f]+", "", text)}
    return identity.key(sorted(found.items()))


def of(entry):
    """What output.run_json() writes of an entry's code."""
    return {"renderer": renderer(entry), "python": python(entry.measure)}


def changed(run):
    """Which of the two have changed since a run was measured; both where it does not tell."""
    return [part for part, now in of(run.entry).items() if run.code.get(part) != now]
