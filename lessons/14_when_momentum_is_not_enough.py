"""When momentum is not enough

The ground gave all it can, and the robot falls. Where must the next foot go?
"""

import numpy as np

import momentum_lab.lesson as lab
from momentum_lab.experiments.measured import pelvis_turn, push_end, times
from momentum_lab.lesson import quantities as q

LATER = 0.3  # after the push, s
PUSH = (lab.Push(velocity_change=0.44, duration=0.1, start=0.2),)
RUNS = {
    "push": lab.Run("fig7", {"pushes": PUSH, "priority": 1.0, "seconds": 1.8}),
    "cat": lab.Run("flight"),
}


def beyond(late):
    """How far in front of the toes the capture point is, so late after the push, s; mm."""

    def distance(session):
        tick = np.searchsorted(times(session), push_end(session) + late)
        return 1e3 * (session.recording.column("capture_point")[tick, 0] - q.toes(session))

    return distance


def turned(session):
    """How far the pelvis is turned in the end, degrees."""
    return np.degrees(np.linalg.norm(pelvis_turn(session)[-1]))


def summed(session):
    """How far the body would be turned if it were one rigid piece with that angular momentum, degrees."""
    spin = session.recording.column("momentum")[:, 3:].sum(axis=0) * session.scenario.timestep
    return np.degrees(np.linalg.norm(np.linalg.solve(session.dynamics.locked_inertia, spin)))


MEASURES = {
    "push": lab.of("push", q.push_force, "N"),
    "fell": lab.fate("push"),
    "now": lab.of("push", beyond(0.0), "mm"),
    "later": lab.of("push", beyond(LATER), "mm"),
    "later_by": lab.of("push", lambda s: 1e3 * LATER, "ms"),
    "growth": lab.of("push", lambda s: beyond(LATER)(s) / beyond(0.0)(s), "times", ".1f"),
    "turned": lab.of("cat", turned, "degrees", ".1f"),
    "summed": lab.of("cat", summed, "degrees", ".1f"),
    "told": lab.of("cat", lambda s: 100.0 * summed(s) / turned(s), "%"),
}

STEPS = (
    lab.Prose(
        "After a push of {push}, the CoP is at the toes and the body may not turn: this robot is going to fall. "
        "Only a foot where the capture point is could still stop it."
    ),
    lab.Number(
        "As the push ends, the capture point is {now} in front of the toes. And {later_by} later?",
        "later",
        0,
        500,
    ),
    lab.Play("Watch the purple cross, the capture point.", "push", ("push", "priority"), view="Side"),
    lab.Compare(
        "It went from {now} to {later}, {growth} as far, and the robot {fell}. A late step has to be a long one.",
        ("later",),
    ),
    lab.Explain(
        "The capture point runs away from the CMP, and the farther it is, the faster. A foot set down beyond it "
        "brings the CMP in front of it again. Omega is the rate at which a stick falls.",
        "push",
        0.4,
        lab.Equation(
            "dxi_x = omega * (xi_x - s_x)",
            {"dxi_x": q.CAPTURE_RATE, "omega": q.PENDULUM_RATE, "xi_x": q.CAPTURE_X, "s_x": q.CMP_X},
            within=0.06,
            unit="m/s",
            share=0.95,
            since=0.31,
        ),
    ),
    lab.Prose(
        "One thing no momentum can tell. Drop the robot once more, and let its legs go round as in lesson 3."
    ),
    lab.Choice(
        "A controller measures the angular momentum all the time, without any error. Can it tell from that how "
        "far the body has turned?",
        (
            lab.Option(
                "Yes: added up over time, as speed adds up to distance",
                lambda m: abs(m["summed"] - m["turned"]) <= 0.5 * m["turned"],
            ),
            lab.Option("There is nothing to tell: the body has not turned", lambda m: m["turned"] < 1.0),
            lab.Option(
                "No: what is added up is not the turn",
                lambda m: m["turned"] >= 1.0 and abs(m["summed"] - m["turned"]) > 0.5 * m["turned"],
            ),
        ),
    ),
    lab.Play("Watch the hips, and the angular momentum in the plot.", "cat", view="Whole robot"),
    lab.Compare(
        "The body has turned by {turned}. Its angular momentum, added up, tells {summed}. Linear momentum, "
        "added up, tells where the CoM is; angular momentum tells no direction that a body faces. So a "
        "controller that knows momenta alone lets the body drift. This lab keeps the pelvis upright by a "
        "term of its own.",
        ("turned",),
    ),
)

CLAIMS = (
    lab.Falls("push"),
    lab.Bound("as the push ends, the capture point is beyond the toes", "now", low=5.0),
    lab.Bound("the step that is needed grows", "growth", low=1.5),
    lab.Bound("in the air the body is turned", "turned", low=20.0),
    # The legs move fast: what ticks of 1 ms leave of their momentum adds up to a degree or two.
    lab.Bound("and its angular momentum does not tell", "told", high=10.0),
)
