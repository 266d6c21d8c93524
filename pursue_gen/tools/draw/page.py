"""Answers what the page asks for, without HTTP: views and changes of a text, saving, solving."""

from __future__ import annotations

import threading
from pathlib import Path
from typing import Any, Callable, Dict, Mapping, Optional

from pursue_gen.diagnostics import PursueError, error
from pursue_gen.drawing.floor_picture import CLOSE, read_floor
from pursue_gen.drawing.ground import read_ground
from pursue_gen.language.syntax import MOST_LETTERS
from pursue_gen.language.tokens import plain
from pursue_gen.tools.draw import fields, storage
from pursue_gen.tools.draw.jobs import Jobs
from pursue_gen.tools.draw.operations import ANYBODY, change
from pursue_gen.tools.draw.view import forms, view

Answer = Dict[str, Any]


class DrawPage:
    """A scenario that is being drawn. Its requests may come from several threads at once."""

    def __init__(self, file: Path, plan: Optional[Path], jobs: Jobs, anew: bool = False) -> None:
        """`plan`: the yaml file of the map under the picture; `anew`: until it is saved, what is in the file does not
        matter. Raises PursueError (exit status 2) for a map that cannot be used.
        """
        self.file, self.jobs, self._anew = file, jobs, anew
        self._floor = None if plan is None else read_floor(plan, CLOSE)
        self._ground = None if plan is None else read_ground(plan)
        self._lock = threading.Lock()

    @property
    def picture(self) -> Optional[bytes]:
        """The floor plan as PNG."""
        return None if self._floor is None else self._floor.picture

    def answer(self, request: str, body: Mapping[str, Any]) -> Answer:
        """The answer to a request; {"refused": …} where it cannot be met, with the reason in words."""
        known: Mapping[str, Callable[[Mapping[str, Any]], Answer]] = {
            "open": self._open,
            "view": lambda values: {"view": self._view(_text(values))},
            "change": self._change,
            "save": self._save,
            "solve": lambda values: self.jobs.solve(_text(values)),
            "play": lambda values: self.jobs.play(_text(values)),
            "survey": self._survey,
            "say": lambda values: self.jobs.say(fields.text_of(values, "line")),
            "job": lambda values: self.jobs.state(),
            "cancel": lambda values: self.jobs.cancel(),
        }
        try:
            if request not in known:
                raise fields.refused("this is not known here", "load the page again")
            return known[request](body)
        except PursueError as problem:
            first = problem.diagnostics[0]
            return {"refused": first.message, "hint": first.hint, "code": first.code}

    def _open(self, _: Mapping[str, Any]) -> Answer:
        """What a page that is loaded begins with: the text of the file, as it is now."""
        text, version = storage.opened(self.file)
        text, floor = "" if self._anew else text, self._floor
        plan = None if floor is None else {
            "width": floor.width * floor.resolution, "height": floor.height * floor.resolution,
            "x": floor.x, "y": floor.y, "yaw": floor.yaw,
        }  # fmt: skip
        new = self._anew or version == storage.NOTHING
        about = {"file": self.file.name, "version": version, "new": new, "floor": plan}
        return {"text": text, **about, "forms": forms(), "anybody": list(ANYBODY), "view": self._view(text)}

    def _view(self, text: str) -> Answer:
        return view(text, self.file.name, self._ground, self.jobs.told)

    def _change(self, values: Mapping[str, Any]) -> Answer:
        """The text after an operation, and how it looks."""
        done = change(_text(values), values.get("operation"), self.file.name)
        return {"text": done.text, "statement": done.statement, "view": self._view(done.text)}

    def _survey(self, values: Mapping[str, Any]) -> Answer:
        """Begins to measure the ways on the map: {radius, speed, ways}, as for `SurveyWork`."""
        radius = None if values.get("radius") is None else fields.positive_of(values, "radius", 10)
        speed = None if values.get("speed") is None else fields.positive_of(values, "speed", 100)
        return self.jobs.survey(_text(values), radius, speed, fields.is_set(values, "ways"))

    def _save(self, values: Mapping[str, Any]) -> Answer:
        """Saves the text; with `overwrite` also where the file is not of the version any more that the page had."""
        text = _text(values)
        with self._lock:
            if not values.get("overwrite") and storage.version(self.file) != values.get("version"):
                hint = "save over it, or copy your text and load the page again, which reads the file"
                message = f"{self.file.name} has changed since it was read or saved on this page"
                raise PursueError([error("DRW003", message, hint=hint)])
            version, self._anew = storage.save(self.file, text), False
        return {"saved": self.file.name, "version": version}


def _text(values: Mapping[str, Any]) -> str:
    text = values.get("text")
    if not isinstance(text, str) or len(text) > MOST_LETTERS + 1:
        raise fields.refused(f"the page sent no text of at most {MOST_LETTERS:,} letters", "make it shorter")
    return plain(text)


def file_for(scenario: Optional[Path], floor: Optional[Path]) -> Path:
    """The scenario's file, where none is named: called like the map, in the present folder."""
    from pursue_gen.language.names import fitting

    return scenario or Path(f"{fitting(floor.stem) if floor is not None else 'my_floor'}.pur")
