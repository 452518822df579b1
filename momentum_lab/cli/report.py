"""momentum-lab report: a run as one HTML file."""

from __future__ import annotations

from argparse import Namespace
from pathlib import Path

from momentum_lab.cli.choices import chosen_run
from momentum_lab.cli.finished import finished
from momentum_lab.errors import InputError
from momentum_lab.trace import writable_file, write_whole


def report(args: Namespace) -> int:
    """Run a scenario or a code and write its report, of two robots side by side.

    Returns:
        0, or 1 if the simulation broke down on the way: the report then shows what there is.

    Raises:
        InputError: something that was typed cannot be used.
        KeyboardInterrupt: Ctrl+C; no report is written.
    """
    if args.out is None:
        raise InputError("--out", "nothing", "the path of an .html file")
    chosen = chosen_run(args)
    out = writable_file(Path(args.out))
    run, error = finished(chosen)

    from momentum_lab.experiments.run_report import report as written  # loads matplotlib

    write_whole(out, written(run))
    print(f"report: {out}")
    return 0 if error is None else 1
