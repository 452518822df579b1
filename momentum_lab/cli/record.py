"""momentum-lab record: a run as a file that plays in a browser without the lab."""

from __future__ import annotations

from argparse import Namespace
from pathlib import Path

from momentum_lab.cli.choices import chosen_run
from momentum_lab.cli.finished import finished
from momentum_lab.cli.progress import progress
from momentum_lab.errors import InputError
from momentum_lab.trace import writable_file, write_whole

_ENDINGS = ".html (plays in any browser) or .viser (for viser's player)"


def record(args: Namespace) -> int:
    """Run a scenario or a code and write what it looked like, two robots side by side.

    Returns:
        0, or 1 if the simulation broke down on the way: the recording then shows what there is.

    Raises:
        InputError: something that was typed cannot be used.
        KeyboardInterrupt: Ctrl+C; no recording is written.
    """
    out = _out(args.out)
    run, error = finished(chosen_run(args))

    from momentum_lab.app.recorder import html_file, viser_file  # loads viser

    make = html_file if out.suffix.lower() == ".html" else viser_file
    with progress(out.name) as report:
        write_whole(out, make(run, report))
    print(f"recording: {out}")
    return 0 if error is None else 1


def _out(given: str | None) -> Path:
    """Where the recording goes.

    Raises:
        InputError: nothing was given, or it cannot be written there, or ends otherwise.
    """
    if given is None:
        raise InputError("--out", "nothing", f"the path of a file that ends in {_ENDINGS}")
    kind = Path(given).suffix.lower()
    if kind == ".mp4":
        raise InputError("--out", given, f"a file that ends in {_ENDINGS}; films are taken in the Share tab")
    if kind not in (".html", ".viser"):
        raise InputError("--out", given, f"a file that ends in {_ENDINGS}")
    return writable_file(Path(given))
