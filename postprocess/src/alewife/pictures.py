"""The commands `alewife-post`, `alewife-picture`, `alewife-film` and `alewife-series`.

They are here, and not in `alewife_post`, to say in one line what is missing where the packages that
draw are not installed.
"""

from __future__ import annotations

import sys
from importlib.util import find_spec

NEEDED = ("matplotlib", "pyvista")
SIZE = "835 MB installed, most of it VTK"


def missing() -> str | None:
    """What is missing for pictures and what helps, or nothing."""
    names = [name for name in NEEDED if find_spec(name) is None]
    if not names:
        return None
    return f"needs {', '.join(names)}: pip install 'alewife[pictures]' ({SIZE})"


def main(arguments: list[str] | None = None) -> int:
    """Pictures, films, curves and summaries of runs."""
    arguments = sys.argv[1:] if arguments is None else arguments
    reason = missing()
    # A summary is text.
    if reason and arguments[:1] != ["inspect"]:
        print(f"alewife-post: {reason}", file=sys.stderr)
        return 2
    from alewife_post import cli

    return cli.main(arguments)


def picture() -> int:
    """`alewife-post picture` in one word."""
    return main(["picture", *sys.argv[1:]])


def film() -> int:
    """`alewife-post film` in one word."""
    return main(["film", *sys.argv[1:]])


def series() -> int:
    """`alewife-post plot` by its older name."""
    return main(["plot", *sys.argv[1:]])


if __name__ == "__main__":
    raise SystemExit(main())
