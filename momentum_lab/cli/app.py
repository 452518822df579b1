"""momentum-lab app: the lab in the browser."""

from __future__ import annotations

from argparse import Namespace

from momentum_lab.cli.choices import chosen_scenario
from momentum_lab.scenario import sides
from momentum_lab.session import Session


def app(args: Namespace) -> int:
    """Serve the app until it is stopped.

    Raises:
        InputError: something that was typed cannot be used, or the port is taken.
    """
    scenario = chosen_scenario(args)
    # A session finds everything that is wrong with a robot or a scenario, before a browser opens.
    for side in sides(scenario):
        Session(side, capacity=1)

    from momentum_lab.app.server import serve

    serve(scenario, host=args.host, port=args.port, open_browser=not args.no_browser)
    return 0
