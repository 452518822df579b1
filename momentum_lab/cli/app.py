"""momentum-lab app: the lab in the browser."""

from __future__ import annotations

from argparse import Namespace

from momentum_lab.cli.choices import chosen_run
from momentum_lab.scenario import sides
from momentum_lab.session import Session


def app(args: Namespace) -> int:
    """Serve the app until it is stopped.

    Raises:
        InputError: something that was typed cannot be used, or the port is taken.
    """
    args.scenario = args.scenario or ("stand" if args.code is None else "")
    run = chosen_run(args)
    # Sessions find everything that is wrong with a robot, a scenario or events, before a browser opens.
    first, *_ = [Session(side, capacity=1) for side in sides(run.scenario)]
    first.check(entry.event for entry in run.events)

    from momentum_lab.app.server import serve

    serve(run, host=args.host, port=args.port, open_browser=not args.no_browser, demo=args.demo)
    return 0
