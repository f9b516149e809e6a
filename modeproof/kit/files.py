"""Writes files as a whole or not at all; what is no regular file is written to, and never replaced."""

from __future__ import annotations

import contextlib
import errno
import json
import os
import sys
import tempfile
import time
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from modeproof.kit.errors import Unjudged

_ATTEMPTS, _PAUSE_S = 20, 0.05
"""A search engine or a virus scanner lets go of a file within a second; an editor may not."""

STDOUT = Path("-")
"""Stands for standard output."""


@contextlib.contextmanager
def to_standard_output(values: Iterable[object]) -> Iterator[None]:
    """Where an option names standard output for a file, all else that is printed goes to standard error.

    Raises Unjudged where two do.
    """
    wanted = sum(isinstance(value, Path) and value == STDOUT for value in values)
    if wanted > 1:
        raise Unjudged("two options write to `-`, standard output: give one of them a file")
    with contextlib.redirect_stdout(sys.stderr) if wanted else contextlib.nullcontext():
        yield


def write_whole(path: Path, content: bytes, mode: int = 0o644) -> None:
    """Write a file atomically. Raises OSError when that fails; then the old file, if any, is still there.

    `-` is standard output. A device, a pipe, or a name in /dev such as /dev/stdout gets the content; it stays
    what it is. Where the path is a link, the file that it leads to is written.
    """
    if path == STDOUT:
        with open(1, "wb", closefd=False) as stream:
            stream.write(content)
        return
    if path.parent == Path("/dev") or (path.exists() and not path.is_file()):
        with path.open("ab") as stream:
            stream.write(content)
        return
    path = Path(os.path.realpath(path))
    part = ""
    try:
        handle, part = tempfile.mkstemp(prefix=f".{path.name}.", suffix=".part", dir=path.parent)
        with os.fdopen(handle, "wb") as stream:
            stream.write(content)
            stream.flush()
            os.fsync(stream.fileno())
        os.chmod(part, mode)
        _replace(part, path)
        part = ""
        with contextlib.suppress(OSError):  # not every system opens a folder
            folder = os.open(path.parent, os.O_RDONLY)
            try:
                os.fsync(folder)
            finally:
                os.close(folder)
    finally:  # an interruption leaves nothing behind either
        if part:
            with contextlib.suppress(OSError):
                os.unlink(part)


def _replace(part: str, path: Path) -> None:
    """Put a file into its place. Windows refuses that while another program has the old one open."""
    for _ in range(_ATTEMPTS - 1):
        with contextlib.suppress(PermissionError):
            os.replace(part, path)
            return
        time.sleep(_PAUSE_S)
    os.replace(part, path)


def can_be_written(path: Path) -> None:
    """Raise Unjudged where a file surely cannot be written later, before anybody waits for it."""
    if path == STDOUT:
        return
    error = 0
    if not path.parent.is_dir():
        error = errno.ENOTDIR if path.parent.exists() else errno.ENOENT
    elif path.is_dir():
        error = errno.EISDIR
    elif not os.access(path if path.exists() else path.parent, os.W_OK):
        error = errno.EACCES
    if error:
        raise Unjudged(f"{path}: cannot be written: {os.strerror(error)}")


def write_json(path: Path, record: Mapping[str, Any]) -> None:
    """Write a record as a whole or not at all. Raises Unjudged when that is not possible."""
    write_text(path, json.dumps(record, indent=1, ensure_ascii=False, allow_nan=False) + "\n")


def write_text(path: Path, text: str) -> None:
    """Write a text as a whole or not at all. Raises Unjudged when that is not possible.

    Half a surrogate pair, which UTF-8 does not have, is written as the escape that JSON reads.
    """
    try:
        write_whole(path, text.encode("utf-8", "backslashreplace"))
    except OSError as error:
        raise Unjudged(f"{path}: cannot be written: {error.strerror or error}") from None
