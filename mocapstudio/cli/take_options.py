"""The options of every command that reads takes, and what they mean."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from dataclasses import dataclass, fields
from fractions import Fraction
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, get_type_hints

import typer

if TYPE_CHECKING:
    from mocapstudio.formats import ReadOptions

Up = Literal["x", "y", "z"]
Forward = Literal["x", "-x", "y", "-y", "z", "-z"]

_PANEL = "How takes are read"


def _rate(text: str) -> Fraction:
    from mocapstudio.formats.options import parse_rate

    return parse_rate(text)


def _unit(text: str) -> float:
    from mocapstudio.formats.options import parse_unit

    return parse_unit(text)


Fps = Annotated[
    Fraction | None,
    typer.Option(
        "--fps",
        parser=_rate,
        metavar="RATE",
        help="Frame rate, in place of what the file says.",
        rich_help_panel=_PANEL,
    ),
]
Unit = Annotated[
    float | None,
    typer.Option(
        "--unit",
        parser=_unit,
        metavar="UNIT",
        help="Unit of length: m, cm, mm, in, asf, or what it is in metres.",
        rich_help_panel=_PANEL,
    ),
]
UpAxis = Annotated[
    Up | None,
    typer.Option("--up", help="The axis of the file that points up.", rich_help_panel=_PANEL),
]
ForwardAxis = Annotated[
    Forward | None,
    typer.Option(
        "--forward", help="The axis of the file that points forward.", rich_help_panel=_PANEL
    ),
]
Angles = Annotated[
    Literal["degrees", "radians"],
    typer.Option("--angles", help="Unit of the file's angles.", rich_help_panel=_PANEL),
]
RootOffset = Annotated[
    Literal["replace", "add"],
    typer.Option(
        "--root-offset",
        help="Whether the root's position replaces its OFFSET or is added to it.",
        rich_help_panel=_PANEL,
    ),
]
TPose = Annotated[
    Literal["trim", "keep"],
    typer.Option(
        "--t-pose",
        help="Whether rows of a T-pose before the motion are left out of the analysis.",
        rich_help_panel=_PANEL,
    ),
]
Lenient = Annotated[
    bool,
    typer.Option(
        "--lenient",
        help="Read the whole rows there are, whatever number is stated.",
        rich_help_panel=_PANEL,
    ),
]
Asf = Annotated[
    Path | None,
    typer.Option(
        "--asf",
        metavar="FILE",
        help="The skeleton of AMC files, where their names and folder do not tell it.",
        rich_help_panel=_PANEL,
    ),
]
JointMap = Annotated[
    Path | None,
    typer.Option(
        "--joint-map",
        metavar="FILE",
        help="JSON object: names of joints in the context and what they are called in the take.",
        rich_help_panel=_PANEL,
    ),
]
Context = Annotated[
    list[Path] | None,
    typer.Option(
        "--context",
        metavar="PATH",
        help="A take, or a folder of takes, to search for neighbours; may be repeated.",
    ),
]

OPTION_OF = {
    "fps": "--fps",
    "unit": "--unit",
    "up": "--up",
    "forward": "--forward",
    "angles": "--angles",
    "root_offset": "--root-offset",
    "trim_start": "--t-pose",
    "lenient": "--lenient",
}
"""By which option the user decides what a reader guessed, by field of `ReadOptions`."""


@dataclass(frozen=True)
class TakeOptions:
    """How takes are read, as the user wants it; every field is an option of the command line."""

    fps: Fps = None
    unit: Unit = None
    up: UpAxis = None
    joint_map: JointMap = None
    forward: ForwardAxis = None
    angles: Angles = "degrees"
    root_offset: RootOffset = "replace"
    t_pose: TPose = "trim"
    lenient: Lenient = False
    asf: Asf = None

    def reading(self) -> ReadOptions:
        """Return what the readers are told."""
        from mocapstudio.formats import ReadOptions

        return ReadOptions(
            fps=self.fps,
            unit=self.unit,
            up=self.up,
            forward=self.forward,
            angles=self.angles,
            root_offset=self.root_offset,
            trim_start=self.t_pose == "trim",
            lenient=self.lenient,
            skeleton=self.asf,
        )


Command = Callable[..., None]


def with_options(kind: type[Any], name: str) -> Callable[[Command], Command]:
    """Give a command an option for every field of a dataclass, in place of one parameter.

    Parameters
    ----------
    kind
        The dataclass; its annotations are typer's.
    name
        The parameter to which an instance is passed.
    """
    hints = get_type_hints(kind, include_extras=True)

    def expanded(command: Command) -> Command:
        own = inspect.signature(command, eval_str=True)
        parameters = [p for p in own.parameters.values() if p.name != name]
        parameters += [
            inspect.Parameter(
                field.name,
                inspect.Parameter.KEYWORD_ONLY,
                default=field.default,
                annotation=hints[field.name],
            )
            for field in fields(kind)
        ]

        @wraps(command)
        def run(**words: Any) -> None:
            chosen = {field.name: words.pop(field.name) for field in fields(kind)}
            command(**words, **{name: kind(**chosen)})

        run.__signature__ = own.replace(parameters=parameters)  # type: ignore[attr-defined]
        run.__annotations__ = {p.name: p.annotation for p in parameters}
        return run

    return expanded


with_take_options = with_options(TakeOptions, "reading")
"""Gives a command the options of `TakeOptions`, in place of its parameter `reading`."""
