"""The command `completion`: the lines that let a shell complete commands and options."""

from __future__ import annotations

import argparse
from typing import Any, cast

from modeproof.ground.errors import EXIT_AS_EXPECTED, Unjudged
from modeproof.ground.places import documents, root

HOW = {
    "bash": 'add to ~/.bashrc: eval "$(modeproof completion bash)"',
    "zsh": 'add to ~/.zshrc, below compinit: eval "$(modeproof completion zsh)"',
    "fish": "write it to ~/.config/fish/completions/modeproof.fish",
    "powershell": "add to $PROFILE: modeproof completion powershell | Out-String | Invoke-Expression",
}
"""For each shell where its lines belong."""


def add_parser(commands: Any) -> None:
    """Add the command; `args.run(args)` returns 0."""
    parser = commands.add_parser(
        "completion",
        epilog="; ".join(f"{shell}: {how}" for shell, how in HOW.items()),
    )
    parser.add_argument("shell", choices=list(HOW), help="whose lines are printed")
    parser.set_defaults(run=run)


def answer(parser: argparse.ArgumentParser) -> None:
    """Answer the shell that asks, from the commands and options of a parser, and end."""
    import argcomplete

    argcomplete.autocomplete(parser, default_completer=cast(Any, _values))


def _values(prefix: str, action: argparse.Action, **given: Any) -> list[str]:
    """What may stand for an argument that has no list of its own: names of this project, else files."""
    from argcomplete.completers import FilesCompleter

    place = root()
    if action.dest in ("target", "targets"):
        return [folder.name for folder in sorted((place / "vectors").glob("*/"))]
    if action.dest == "document":
        return list(documents(place))
    if action.dest == "word":
        from modeproof.explain.things import names

        return names(place)
    return [str(name) for name in FilesCompleter()(prefix)]


def run(args: argparse.Namespace) -> int:
    """Print the lines. Raises Unjudged where argcomplete is missing."""
    try:
        import argcomplete.shell_integration
    except ModuleNotFoundError:
        raise Unjudged("the package argcomplete is missing; install modeproof again") from None
    print(f"# {HOW[args.shell]}")
    print(argcomplete.shell_integration.shellcode(["modeproof"], shell=args.shell).strip())
    return EXIT_AS_EXPECTED
