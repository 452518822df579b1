"""How far can it go?

Without a step, is there a largest push that can be survived, and does your robot have to stop there?
"""

import numpy as np

import momentum_lab.lesson as lab
from momentum_lab.lesson import quantities as q
from momentum_lab.momentum.pendulum import pendulum_frequency, pendulum_impulse_bound


def push(speed, priority):
    pushes = (lab.Push(velocity_change=speed, duration=0.1, start=0.2),)
    return lab.Run("fig7", {"pushes": pushes, "priority": priority, "seconds": 1.8})


RUNS = {"turning": push(0.44, 0.0), "stiff": push(0.44, 1.0), "too_far": push(0.6, 0.0)}


def omega(session):
    """How fast a pendulum as high as the CoM falls, 1/s."""
    return float(pendulum_frequency(session.recording.column("com")[0, 2]))


def reach(session):
    """From the CoM to the front edge of the feet, m."""
    column = session.recording.column
    return float(column("sole_pose")[0, :, 0].mean() + session.robot.soles[0].upper[0] - column("com")[0, 0])


def ratio(runs, label):
    """The push as part of the largest that a pendulum survives on its CoP, %."""
    session = runs[label]
    applied = session.pushes[0]
    bound = pendulum_impulse_bound(session.robot.mass, omega(session), reach(session), applied.duration)
    return 100.0 * applied.impulse / bound


def bound(runs):
    session = runs["turning"]
    return pendulum_impulse_bound(session.robot.mass, omega(session), reach(session), 0.1)


def capture_beyond(runs):
    """How far beyond the front edge the capture point goes, mm."""
    session = runs["turning"]
    moved = session.recording.column("capture_point")[:, 0] - session.recording.column("com")[0, 0]
    return 1e3 * float(moved.max() - reach(session))


def falling(session):
    """The pendulum's rate with the CoM as high as it is (n,), 1/s."""
    return np.sqrt(9.81 / session.recording.column("com")[:, 2])


def slope(session):
    """Rate of the capture point, from differences over a tick, m/s."""
    return np.diff(session.recording.column("capture_point")[:, 0]) / session.scenario.timestep


def fate(runs, label):
    return "stands" if runs[label].fall is None else "falls"


MEASURES = {
    "reach": lab.Measure(lambda runs: 1e3 * reach(runs["turning"]), "mm"),
    "bound": lab.Measure(bound, "N s", ".1f"),
    "ratio": lab.Measure(lambda runs: ratio(runs, "turning"), "%"),
    "far_ratio": lab.Measure(lambda runs: ratio(runs, "too_far"), "%"),
    "turning": lab.Measure(lambda runs: fate(runs, "turning")),
    "stiff": lab.Measure(lambda runs: fate(runs, "stiff")),
    "too_far": lab.Measure(lambda runs: fate(runs, "too_far")),
    "beyond": lab.Measure(capture_beyond, "mm"),
}

STEPS = (
    lab.Prose(
        "Take away all turning, and a robot is a stick on a point, the CoP, that moves within the feet: {reach} "
        "from below the CoM to the toes. The capture point says where that point must be to stop the stick. Beyond "
        "the toes, the stick is lost."
    ),
    lab.Number("How large is the largest push the stick survives?", "bound", 0, 100),
    lab.Choice(
        "The robot gets {ratio} of that push. Can it survive?",
        (
            lab.Option("No, never", lambda m: m["turning"] == "falls" == m["stiff"]),
            lab.Option(
                "Only if its body may turn", lambda m: m["turning"] == "stands" and m["stiff"] == "falls"
            ),
            lab.Option("Yes, in any case", lambda m: m["turning"] == "stands" == m["stiff"]),
        ),
    ),
    lab.Play(
        "Find the largest push that it survives. Then change the priority.", "turning", ("push", "priority")
    ),
    lab.Compare(
        "The robot that turns {turning}, its capture point {beyond} beyond the toes. The one that does not turn "
        "{stiff}. At {far_ratio} even the first {too_far}.",
        ("ratio", "turning", "stiff", "beyond", "too_far"),
    ),
    lab.Explain(
        "The capture point runs away from the CMP, the faster the farther. The CMP may leave the feet, for as long "
        "as the body can turn: that is the reserve, and it is small.",
        "turning",
        0.35,
        lab.Equation(
            "dxi_x = omega * (xi_x - s_x)",
            {
                "dxi_x": lab.Symbol(slope, "m/s", "rate of the capture point", ".3f"),
                "omega": lab.Symbol(falling, "1/s", "the pendulum's rate", ".2f"),
                "xi_x": q.CAPTURE_X,
                "s_x": q.CMP_X,
            },
            within=0.05,
            unit="m/s",
            share=0.99,
            since=0.31,
        ),
    ),
)

CLAIMS = (
    lab.Bound("the push is larger than a pendulum's largest", "ratio", low=105.0),
    lab.Bound("the capture point goes beyond the toes", "beyond", low=5.0),
    lab.Stands("turning", "the robot that may turn"),
    lab.Falls("stiff", "the robot that must not turn"),
    lab.Falls("too_far", "with a much larger push the robot"),
)
