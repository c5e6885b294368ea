"""A client of the Lacuna render service, in one file: copy it, or put its folder into PYTHONPATH.

    from lacuna import Service

    lacuna = Service()
    job = lacuna.submit({"scene": "ajar.glb", "camera": "room", "integrator": {"type": "path"},
                         "budget": {"seconds": 10}, "reference": "auto"})
    lacuna.wait(job)
    print(lacuna.curve(job)[-1]["relmse"])

It needs the standard library alone; where numpy is installed, `image` returns an array of it. Jobs and sweeps are plain
dictionaries, checked by the service: `schema` is its JSON Schema of them.
"""

from __future__ import annotations

import csv
import io
import json
import os
import pathlib
import struct
import time
import urllib.error
import urllib.parse
import urllib.request
import uuid
from collections.abc import Callable, Iterable
from typing import Any

__all__ = ["Failed", "Refused", "Service"]

ENDED = {"done", "failed", "cancelled"}


class Refused(Exception):
    """The service has refused a request.

    status: of HTTP; title, detail: its reason; errors: a dictionary for each mistake in a job or a sweep, with the JSON
    pointer of its place.
    """

    def __init__(self, status: int, problem: dict[str, Any]):
        self.status = status
        self.title = problem.get("title", "")
        self.detail = problem.get("detail", "")
        self.errors: list[dict[str, Any]] = problem.get("errors", [])
        mistakes = "".join(f"\n  {e.get('pointer', '')}: {e.get('detail', '')}" for e in self.errors)
        super().__init__(f"{status} {self.title}: {self.detail}{mistakes}")


class Failed(Exception):
    """A job or a sweep that was waited for has not ended as `done`; `ended`: {id: the service's description of it}."""

    def __init__(self, ended: dict[str, dict[str, Any]]):
        self.ended = ended
        super().__init__("; ".join(
            f"{name} {_state(entry)}: {_error(entry) or 'no reason given'}" for name, entry in ended.items()))


class Service:
    """A running `lacuna-server`.

    url: its address, else that of the environment variable LACUNA_URL, else http://127.0.0.1:8017; token: of
    --token-file, else that of LACUNA_TOKEN; timeout: the longest wait for an answer, seconds. Each method raises Refused where the service refuses, and OSError where there is none.
    """

    def __init__(self, url: str | None = None, token: str | None = None, timeout: float = 30):
        self.url = (url or os.environ.get("LACUNA_URL") or "http://127.0.0.1:8017").rstrip("/")
        self.token = token if token is not None else os.environ.get("LACUNA_TOKEN")
        self.timeout = timeout

    # Jobs.

    def submit(self, job: dict[str, Any], key: str | None = None) -> str:
        """Queues a job and returns its id, once it is stored. The same `key` and job are queued once, however often."""
        return self._post_once("/api/jobs", job, key)

    def job(self, job: str) -> dict[str, Any]:
        """What the service says of a job: its settings, state, progress, priority and files."""
        return self._json("GET", f"/api/jobs/{_quoted(job)}")

    def wait(self, *jobs: str, timeout: float | None = None, poll: float = 0.5,
             progress: Callable[[dict[str, dict[str, Any]]], None] | None = None) -> list[dict[str, Any]]:
        """Waits until all these jobs have ended, and returns what the service says of each.

        timeout: seconds, then TimeoutError; None: none. poll: seconds between two questions. progress: called after
        each question with {id: description}. Raises Failed if one has failed or was cancelled.
        """
        return self._wait(self.job, jobs, timeout, poll, progress)

    def cancel(self, job: str) -> None:
        """Stops a job; what it has rendered stays."""
        self._request("POST", f"/api/jobs/{_quoted(job)}/cancel")

    def extend(self, job: str, budget: dict[str, Any]) -> None:
        """Resumes a job that has ended, up to a larger budget, as {"seconds": 120}."""
        self._json("POST", f"/api/jobs/{_quoted(job)}/extend", {"budget": budget})

    def delete(self, job: str) -> None:
        """Removes a job that has ended, and its results."""
        self._request("DELETE", f"/api/jobs/{_quoted(job)}")

    # Results.

    def file(self, job: str, name: str) -> bytes:
        """A file of a job's folder, as image.exr, image.png or report.json."""
        return self._request("GET", f"/api/jobs/{_quoted(job)}/files/{_quoted(name)}")

    def curve(self, job: str) -> list[dict[str, float | None]]:
        """Error against time: a row for each instant; an error that is not known is None.

        seconds and cpu_seconds are of rendering; mse, relmse, ... are against the reference, without unit;
        docs/numbers.md defines them.
        """
        return list(_rows(self.file(job, "curve.csv")))

    def image(self, job: str, layer: str = "", tries: int = 4) -> Any:
        """A layer of a picture, linear values in the scene's unit of radiance; "": the picture, "reference": its reference.

        Returns an array of numpy, float32, of shape (height, width, channels), rows from the top; without numpy nested
        lists of the same shape. Values come as half floats with a common scale, and so have a relative error of at most
        2^-11 down to 2^-29 of the largest; the file image.exr has them in full. A job that runs replaces its picture:
        after `tries` that met a replacement OSError is raised.
        """
        for _ in range(tries):
            before = self.file(job, "layers.json")
            data = self.file(job, "layers.half")
            if before == self.file(job, "layers.json"):
                return _picture(json.loads(before), data, layer)
        raise OSError(f"{job}: its picture changed while it was read")

    # Sweeps.

    def sweep(self, sweep: dict[str, Any], key: str | None = None) -> str:
        """Queues a sweep and returns its id, as `submit` does for a job."""
        return self._post_once("/api/sweeps", sweep, key)

    def wait_sweep(self, sweep: str, timeout: float | None = None, poll: float = 1,
                   progress: Callable[[dict[str, dict[str, Any]]], None] | None = None) -> dict[str, Any]:
        """Waits until all runs of a sweep have ended, as `wait` does for jobs, and returns its cells and runs."""
        return self._wait(self._sweep, [sweep], timeout, poll, progress)[0]

    def table(self, sweep: str) -> list[dict[str, Any]]:
        """The curves of all runs of a sweep as one table: a row for each run and instant, with the run's settings."""
        return list(_rows(self._request("GET", f"/api/sweeps/{_quoted(sweep)}/table.csv")))

    def answers(self, sweep: str) -> dict[str, Any]:
        """The comparison of a sweep's finished runs, with intervals of 95 % over their seeds."""
        return self._json("GET", f"/api/sweeps/{_quoted(sweep)}/answers")

    # The rest.

    def upload(self, path: str | os.PathLike[str], name: str | None = None) -> None:
        """Uploads a scene, a .glb, or a .zip of a folder that `lacuna import` has written, under its own name or another."""
        path = pathlib.Path(path)
        name = name or path.name
        kind = "application/zip" if name.endswith(".zip") else "model/gltf-binary"
        self._request("PUT", f"/api/scenes/{_quoted(name)}", path.read_bytes(), kind)

    def scenes(self) -> list[str]:
        """The scenes that jobs can name."""
        return self._json("GET", "/api/scenes")["scenes"]

    def schema(self, of: str = "job") -> dict[str, Any]:
        """The JSON Schema of a "job" or of a "sweep", with every setting, its range, its default and what it does."""
        return self._json("GET", f"/api/schema/{_quoted(of)}")

    def _sweep(self, sweep: str) -> dict[str, Any]:
        return self._json("GET", f"/api/sweeps/{_quoted(sweep)}")

    def _post_once(self, path: str, body: dict[str, Any], key: str | None) -> str:
        # With a key of its own a request that got no answer can be sent again.
        headers = {"Idempotency-Key": key or str(uuid.uuid4())}
        return self._json("POST", path, body, headers)["id"]

    def _wait(self, read: Callable[[str], dict[str, Any]], names: Iterable[str], timeout: float | None, poll: float,
              progress: Callable[[dict[str, dict[str, Any]]], None] | None) -> list[dict[str, Any]]:
        end = None if timeout is None else time.monotonic() + timeout
        while True:
            found = {name: read(name) for name in names}
            if progress:
                progress(found)
            if all(_state(entry) in ENDED for entry in found.values()):
                break
            if end is not None and time.monotonic() >= end:
                open_ones = [name for name, entry in found.items() if _state(entry) not in ENDED]
                raise TimeoutError(f"after {timeout} s not ended: {', '.join(open_ones)}")
            time.sleep(poll)
        bad = {name: entry for name, entry in found.items() if _state(entry) != "done"}
        if bad:
            raise Failed(bad)
        return list(found.values())

    def _json(self, method: str, path: str, body: Any = None, headers: dict[str, str] | None = None) -> Any:
        data = None if body is None else json.dumps(body).encode()
        return json.loads(self._request(method, path, data, "application/json", headers))

    def _request(self, method: str, path: str, data: bytes | None = None, content_type: str = "",
                 headers: dict[str, str] | None = None) -> bytes:
        request = urllib.request.Request(self.url + path, data, dict(headers or {}), method=method)
        if data is not None:
            request.add_header("Content-Type", content_type)
        if self.token:
            request.add_header("Authorization", f"Bearer {self.token}")
        try:
            with urllib.request.urlopen(request, timeout=self.timeout) as answer:
                return answer.read()
        except urllib.error.HTTPError as error:
            raise Refused(error.code, _problem(error)) from None


def _quoted(name: str) -> str:
    return urllib.parse.quote(name, safe="")


def _problem(error: urllib.error.HTTPError) -> dict[str, Any]:
    text = error.read()
    try:
        problem = json.loads(text)
    except ValueError:
        problem = None
    return problem if isinstance(problem, dict) else {"title": error.reason, "detail": text.decode(errors="replace")}


def _state(entry: dict[str, Any]) -> str:
    state = entry["state"]
    return state["state"] if isinstance(state, dict) else state


def _error(entry: dict[str, Any]) -> str | None:
    state = entry["state"]
    return (state if isinstance(state, dict) else entry).get("error")


def _rows(text: bytes) -> Iterable[dict[str, Any]]:
    """The rows of a CSV file; what reads as a number is one, and what is empty is None."""
    for row in csv.DictReader(io.StringIO(text.decode())):
        yield {name: _value(field) for name, field in row.items()}


def _value(field: str) -> float | int | str | None:
    if field == "":
        return None
    for kind in (int, float):
        try:
            return kind(field)
        except ValueError:
            pass
    return field


def _picture(index: dict[str, Any], data: bytes, name: str) -> Any:
    layers = {layer["name"]: layer for layer in index["layers"]}
    if name not in layers:
        raise KeyError(f"no layer \"{name}\"; there are: {', '.join(repr(known) for known in layers)}")
    layer = layers[name]
    width, height, channels = index["width"], index["height"], len(layer["channels"])
    count = width * height * channels
    values = data[layer["offset"]:layer["offset"] + layer["bytes"]]
    if len(values) != 2 * count:
        raise OSError(f"layers.half has {len(values)} bytes of layer \"{name}\", not {2 * count}")
    try:
        import numpy
    except ImportError:
        flat = [layer["scale"] * value for value in struct.unpack(f"<{count}e", values)]
        pixels = [flat[i:i + channels] for i in range(0, count, channels)]
        return [pixels[y * width:(y + 1) * width] for y in range(height)]
    return (numpy.frombuffer(values, "<f2").astype("f4") * layer["scale"]).reshape(height, width, channels)
