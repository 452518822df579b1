"""How far can it go?

A stick balanced on a fingertip survives small pushes only. How much more can a robot take that may turn?
"""

import momentum_lab.lesson as lab
from momentum_lab.lesson import quantities as q
from momentum_lab.momentum.pendulum import pendulum_frequency, pendulum_impulse_bound


def push(speed, priority):
    pushes = (lab.Push(velocity_change=speed, duration=0.1, start=0.2),)
    return lab.Run("fig7", {"pushes": pushes, "priority": priority, "seconds": 1.8})


RUNS = {"turning": push(0.47, 0.0), "stiff": push(0.47, 1.0), "too_far": push(0.53, 0.0)}
EARLY = 0.35  # just after the push, s


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
    "bound": lab.of("turning", lambda s: bound(s) / s.pushes[0].duration, "N"),
    "lasts": lab.of("turning", lambda s: 1e3 * s.pushes[0].duration, "ms"),
    "ratio": lab.of("turning", ratio, "%"),
    "far_ratio": lab.of("too_far", ratio, "%"),
    "turning": lab.fate("turning"),
    "stiff": lab.fate("stiff"),
    "too_far": lab.fate("too_far"),
    "ahead": lab.at("turning", EARLY, lambda s: 1e3 * (q.CMP_X.values(s) - q.CAPTURE_X.values(s)), "mm"),
    "beyond": lab.of("turning", capture_beyond, "mm"),
}

STEPS = (
    lab.Prose(
        "A robot whose body never turns is such a stick. It stands on a point, the CoP, that can move by "
        "{reach}, from below the CoM to the toes: at best, all at once, that is enough for a push of {bound} "
        "for {lasts}. After a larger one the capture point, where the CoP must be to stop it, is beyond the toes."
    ),
    lab.Number(
        "Of the stick's largest push, how much does a robot survive whose body may turn?", "ratio", 100, 300
    ),
    lab.Play(
        "Watch the purple cross, the capture point, leave the feet. Then find the largest push yourself.",
        "turning",
        ("push", "priority"),
        beside="stiff",
    ),
    lab.Compare(
        "With {ratio} of the stick's push the turning robot {turning}, though its capture point was "
        "{beyond} beyond the toes. The stiff one {stiff}. With {far_ratio}, turning does not "
        "save it: the robot {too_far}.",
        ("ratio", "far_ratio", "stiff", "beyond"),
    ),
    lab.Explain(
        "The capture point runs away from the CMP: only a CMP in front of it drives it back. A stick's CMP is "
        "its CoP, and ends at the toes. A body that turns has its CMP {ahead} in front of the capture point "
        "here. That is the reserve, and it is small, because no body can turn for long. How fast all this "
        "goes is omega, the rate at which a stick as high as the CoM falls.",
        "turning",
        EARLY,
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
    lab.Bound("turning sends the CMP ahead of it", "ahead", low=5.0),
    lab.Falls("stiff", "the robot that must not turn"),
    lab.Falls("too_far", "with a slightly larger push the robot"),
)
