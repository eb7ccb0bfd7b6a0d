"""The table of commands, and what happens around each of them.

A command is a function of the same name in a module of the same name (underscores for hyphens),
which is imported only when that command is asked for: `detect` must not pay for the desk.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from importlib import import_module
from typing import Annotated, Any

import typer
from typer.core import TyperGroup
from typer.main import get_command

from mocapstudio import __version__
from mocapstudio.cli.errors import BAD_INPUT, DONE, exit_code_of

COMMANDS = {
    "review": "Open the desk on a session or on takes.",
    "demo": "Do the main job on the built-in take.",
    "inspect": "Read files and report what is in them, and what was wrong.",
    "detect": "Find what is wrong in takes and how badly.",
    "clean": "Repair all that is found in takes, and write them.",
    "contacts": "Find or read contacts, measure foot skate, remove it.",
    "solve": "Solve markers to the skeleton of a template.",
    "convert": "Write a take in another format.",
    "compare": "Compare performances with a reference: early, late, different.",
    "align": "Align a stream with a reference, frame by frame.",
    "train-weights": "Learn how much each joint counts in aligning.",
    "export": "Write what was decided in a session, without the desk.",
    "report": "Write a session's report.",
    "evaluate": "Measure detection, repair and speed on takes with known errors.",
    "doctor": "Check display, OpenGL, libraries and caches.",
}


def load(name: str) -> Callable[..., Any]:
    """Import the function behind a command."""
    module = name.replace("-", "_")
    function: Callable[..., Any] = getattr(import_module(f"mocapstudio.cli.{module}"), module)
    return function


class LazyGroup(TyperGroup):
    """Shows all commands, imports the one that is run."""

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        """Put the real command in the place of its stub, then resolve it."""
        if args[0] in COMMANDS:
            single = typer.Typer(add_completion=False, rich_markup_mode="markdown")
            single.command(args[0])(load(args[0]))
            self.commands[args[0]] = get_command(single)
        return super().resolve_command(ctx, args)


def application() -> typer.Typer:
    """Build the command line: the options of `mocapstudio` itself and a stub for each command."""
    app = typer.Typer(
        cls=LazyGroup,
        add_completion=False,
        rich_markup_mode="markdown",
        context_settings={"help_option_names": ["-h", "--help"]},
    )

    @app.callback()
    def mocapstudio(
        version: Annotated[
            bool,
            typer.Option("--version", help="Show the version.", is_eager=True, callback=_version),
        ] = False,
    ) -> None:
        """Review and clean motion capture. Without a command, the desk opens."""

    for name, summary in COMMANDS.items():
        app.command(name, help=summary)(_stub)
    return app


def _version(asked: bool) -> None:
    if asked:
        print(f"mocapstudio {__version__}")
        raise typer.Exit


def _stub() -> None:
    """Stand in for a command in the list of commands."""


def run(arguments: Sequence[str] | None = None) -> int:
    """Run a command and return its exit code; nothing but `SystemExit` escapes.

    Parameters
    ----------
    arguments
        The words after `mocapstudio`; those of the shell by default.
    """
    words = list(sys.argv[1:] if arguments is None else arguments) or ["review"]
    group = get_command(application())
    try:
        with group.make_context("mocapstudio", words) as context:
            group.invoke(context)
    except typer.Exit as done:
        return done.exit_code
    except BrokenPipeError:
        return _reader_left()
    except typer.TyperException as error:
        return _wrong_use(error)
    except (Exception, KeyboardInterrupt) as error:
        return exit_code_of(error)
    return DONE


def _wrong_use(error: typer.TyperException) -> int:
    where = getattr(getattr(error, "ctx", None), "command_path", "mocapstudio")
    message = " ".join(error.format_message().split()).rstrip(".")
    print(f"error: {message} (see {where} --help)", file=sys.stderr)
    return BAD_INPUT


def _reader_left() -> int:
    """Leave quietly where the other end of the pipe closed, as in `… | head`."""
    import os

    # Python would complain once more when it flushes standard output at its end.
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    return DONE
