"""Problems of a scene: what is wrong, where, and how to solve it."""

from __future__ import annotations

import html
import json
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Edit:
    """A change of the text: `text` replaces `length` bytes from the byte `offset` on."""

    offset: int
    length: int
    text: str
    file: str | None = None
    """Setting that is changed, such as `--set #2`. None for the scene's text."""


@dataclass(frozen=True)
class Fix:
    """A way to solve a problem."""

    title: str
    applicability: str
    """`safe`, `unsafe` (one meaning of several, or something is removed) or `placeholder`."""
    edits: tuple[Edit, ...]


@dataclass(frozen=True)
class Label:
    """A place that explains a problem. Lines and columns start at 1; columns are in characters."""

    message: str
    line: int
    column: int
    end_line: int
    end_column: int
    offset: int
    length: int
    file: str | None = None
    """Setting in which the place lies, such as `--set #2`. None for the scene's text."""


@dataclass(frozen=True)
class Problem:
    """An error, or a warning, about a scene."""

    severity: str
    """`error` or `warning`."""
    code: str
    """Kind of problem, such as `pinhole::unknown_field`. `pinhole explain` explains it."""
    message: str
    help: str | None
    labels: tuple[Label, ...]
    """Places; the first is where the problem is."""
    fixes: tuple[Fix, ...]


class Problems(tuple[Problem, ...]):
    """Problems in the order of the text, with the report that the program prints about them."""

    report: str

    def __new__(cls, problems: Iterable[Problem], report: str) -> Problems:
        self = super().__new__(cls, problems)
        self.report = report
        return self

    def __getnewargs__(self) -> tuple[tuple[Problem, ...], str]:
        return tuple(self), self.report

    def __repr__(self) -> str:
        return self.report.rstrip() or "no problems"

    def _repr_html_(self) -> str:
        return f'<pre style="line-height: 1.2">{html.escape(repr(self))}</pre>'


class SceneError(ValueError):
    """The text of a scene, or one of its settings, has errors. All `problems` are listed."""

    def __init__(self, problems: Problems) -> None:
        super().__init__(problems)
        self.problems = problems

    def __str__(self) -> str:
        return self.problems.report.rstrip()

    def _render_traceback_(self) -> list[str]:
        """Shows only the report in a notebook; the Python calls do not help to find the problem."""
        return str(self).splitlines()


def from_json(text: str, report: str) -> Problems:
    """Makes problems from the JSON that the program prints about them."""
    return Problems(map(_problem, json.loads(text)), report)


def _problem(facts: dict[str, Any]) -> Problem:
    fixes = (
        Fix(fix["title"], fix["applicability"], tuple(Edit(**edit) for edit in fix["edits"]))
        for fix in facts["fixes"]
    )
    return Problem(
        severity=facts["severity"],
        code=facts["code"],
        message=facts["message"],
        help=facts["help"],
        labels=tuple(Label(**label) for label in facts["labels"]),
        fixes=tuple(fixes),
    )
