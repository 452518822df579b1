"""How far can it go?

A stick balanced on a fingertip survives small pushes only. Does a robot fall at the same push as the stick?
"""

import momentum_lab.lesson as lab
from momentum_lab.lesson import quantities as q
from momentum_lab.momentum.pendulum import pendulum_frequency, pendulum_impulse_bound


def push(speed, priority):
    pushes = (lab.Push(velocity_change=speed, duration=0.1, start=0.2),)
    return lab.Run("fig7", {"pushes": pushes, "priority": priority, "seconds": 1.8})


RUNS = {"turning": push(0.44, 0.0), "stiff": push(0.44, 1.0), "too_far": push(0.6, 0.0)}


def reach(session):
    """From the CoM to the front edge of the feet, m."""
    return q.toes(session) - session.recording.column("com")[0, 0]


def bound(session):
    """The largest push, N s, that a pendulum survives on its CoP."""
    omega = pendulum_frequency(session.recording.column("com")[0, 2])
    return pendulum_impulse_bound(session.robot.mass, omega, reach(session), session.pushes[0].duration)


def ratio(session):
    """The push as part of that, %."""
    return 100.0 * session.pushes[0].impulse / bound(session)


def capture_beyond(session):
    """How far beyond the front edge the capture point goes, mm."""
    return 1e3 * (session.recording.column("capture_point")[:, 0].max() - q.toes(session))


MEASURES = {
    "reach": lab.of("turning", lambda s: 1e3 * reach(s), "mm"),
    "bound": lab.of("turning", bound, "N s", ".1f"),
    "ratio": lab.of("turning", ratio, "%"),
    "far_ratio": lab.of("too_far", ratio, "%"),
    "turning": lab.fate("turning"),
    "stiff": lab.fate("stiff"),
    "too_far": lab.fate("too_far"),
    "beyond": lab.of("turning", capture_beyond, "mm"),
}

STEPS = (
    lab.Prose(
        "A robot whose body never turns is such a stick. It stands on a point, the CoP, that can move by "
        "{reach}, from below the CoM to the toes. The capture point is where the CoP must be to stop it. Once "
        "that is beyond the toes, the stick falls."
    ),
    lab.Number("How large is the largest push that the stick survives?", "bound", 0, 100),
    lab.Choice(
        "The robot gets {ratio} of that push. Can it survive?",
        (
            lab.Option("No, never", lambda m: "stands" not in (m["turning"], m["stiff"])),
            lab.Option("Only if its body may turn", lambda m: m["turning"] == "stands" != m["stiff"]),
            lab.Option("Yes, in any case", lambda m: m["turning"] == "stands" == m["stiff"]),
        ),
    ),
    lab.Play(
        "Watch the capture point in the plot. Then find the largest push that the turning robot survives.",
        "turning",
        ("push", "priority"),
        beside="stiff",
    ),
    lab.Compare(
        "The robot that turns {turning}, though its capture point was {beyond} beyond the toes. The one that "
        "does not turn {stiff}. With {far_ratio} of the stick's push, the first {too_far} as well.",
        ("ratio", "turning", "stiff", "beyond", "too_far"),
    ),
    lab.Explain(
        "The CMP drives the capture point away, the faster the farther apart they are. To drive it back, the "
        "CMP has to be in front of it. A stick's CMP is its CoP and stays on the feet; the CMP of a body that "
        "turns may leave them. That is the reserve, and it is small: a body cannot turn for long.",
        "turning",
        0.35,
        lab.Equation(
            "dxi_x = omega * (xi_x - s_x)",
            {
                "dxi_x": q.CAPTURE_RATE,
                "omega": q.PENDULUM_RATE,
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
