"""Ice, slopes, a moving floor

The robot does nothing wrong, and the ground is the trouble. What can be mended by moving, and what cannot?
"""

import numpy as np

import momentum_lab.lesson as lab
from momentum_lab.lesson import quantities as q

SLOPE = {"roll_deg": 10.0}
RUNS = {
    "slope": lab.Run("stand", {"ground": (SLOPE,), "seconds": 1.0}),
    "icy": lab.Run("stand", {"ground": ({**SLOPE, "friction": 0.1},), "seconds": 1.5}),
    "told": lab.Run("bus", {"seconds": 5.0}),
    "felt": lab.Run("bus", {"seconds": 5.0, "ground_sense": "felt"}),
}


def friction_used(session):
    """Force along the slope over force into it: what friction has to give at least, 1."""
    normal = session.ground.at(0.0).rotation[0][:, 2]
    force = session.recording.latest["foot_wrench_measured"][:, :3].sum(axis=0)
    pressed = float(force @ normal)
    return float(np.linalg.norm(force - pressed * normal)) / pressed


def slid(session):
    """How far the feet have moved on the ground within half a second, mm."""
    way = session.recording.column("sole_pose")[500, :, :3] - session.recording.column("sole_pose")[0, :, :3]
    return 1e3 * float(np.linalg.norm(way, axis=1).max())


def sway(session, name):
    """Largest way of a point along x once the floor sways fully, from its middle, mm."""
    x = session.recording.column(name)[3000:, ..., 0]
    return 500.0 * float(np.ptp(x))


def lag(session):
    """How far the CoM gets from the middle of its feet, mm."""
    over = session.recording.column("com")[:, 0] - session.recording.column("sole_pose")[..., 0].mean(axis=1)
    return 1e3 * float(np.abs(over - over[0]).max())


MEASURES = {
    "tilt": lab.Measure(lambda runs: runs["slope"].scenario.ground[0].roll_deg, "degrees"),
    "needed": lab.Measure(lambda runs: friction_used(runs["slope"]), "", ".3f"),
    "icy_friction": lab.Measure(lambda runs: float(runs["icy"].ground.friction(0.0)[0]), "", ".1f"),
    "icy": lab.Measure(lambda runs: "stands" if runs["icy"].fall is None else "falls"),
    "slid": lab.Measure(lambda runs: slid(runs["icy"]), "mm"),
    "floor": lab.Measure(lambda runs: sway(runs["told"], "ground_pose"), "mm"),
    "cop": lab.Measure(lambda runs: sway(runs["told"], "cop_measured"), "mm"),
    "told": lab.Measure(lambda runs: lag(runs["told"]), "mm", ".1f"),
    "felt": lab.Measure(lambda runs: lag(runs["felt"]), "mm", ".1f"),
}

STEPS = (
    lab.Prose(
        "The ground gives forces, and nothing else. It cannot pull, it cannot reach beyond the soles, and it holds "
        "sideways only as hard as friction lets it. First it is tilted, by {tilt}."
    ),
    lab.Number("How much friction must a slope of {tilt} have, at the least?", "needed", 0.0, 1.0),
    lab.Play(
        "Let it stand on the slope. Then look at the same slope on ice.", "slope", ("priority",), beside="icy"
    ),
    lab.Compare(
        "Standing took {needed}, the tangent of the slope. On ice, with {icy_friction}, the robot {icy}: "
        "its feet slid by {slid} within half a second. No law of control changes that: the force of the ground must "
        "carry the weight, and it cannot point up.",
        ("needed", "icy", "slid"),
    ),
    lab.Prose(
        "Now the floor is level and firm, and it sways: a bus that brakes and speeds up, by {floor} each way."
    ),
    lab.Number("How far does the CoP sway, if the CoM stays above the feet?", "cop", 0.0, 200.0),
    lab.Choice(
        "One robot is told how the bus will move. The other only feels what its soles do. Which CoM strays farther "
        "from its feet?",
        (
            lab.Option("The one that is told", lambda m: m["told"] > 2.0 * m["felt"]),
            lab.Option("The one that feels", lambda m: m["felt"] > 2.0 * m["told"]),
            lab.Option("Both alike", lambda m: 0.5 <= m["told"] / m["felt"] <= 2.0),
        ),
    ),
    lab.Play(
        "Ride along. Watch the CoP run ahead of the CoM.",
        "told",
        ("priority", "linear_stiffness"),
        beside="felt",
    ),
    lab.Compare(
        "The CoP swayed by {cop}, far more than the {floor} of the floor. Told, the CoM strayed by {told}; by "
        "feel alone, by {felt}.",
        ("cop", "told", "felt"),
    ),
    lab.Explain(
        "To speed up with the bus, the CoM needs a force, and that force tilts the line from the CoP to the CoM "
        "(Eq. 21). The CoP pays for the acceleration, and the sole is only so long: a harder bus needs a step, or a "
        "handrail.",
        "told",
        3.0,
        lab.Equation(
            "p_x = r_x - (r_z * dl_x + dk_y) / f_z",
            {
                "p_x": q.COP_X,
                "r_x": q.COM_X,
                "r_z": q.COM_Z,
                "dl_x": q.BRAKING,
                "dk_y": q.TURNING,
                "f_z": q.FORCE_Z,
            },
            within=0.002,
            unit="m",
            share=0.99,
        ),
    ),
)

CLAIMS = (
    lab.Stands("slope", "the robot on the firm slope"),
    lab.Falls("icy", "the robot on the icy slope"),
    lab.Stands("told", "the robot that is told"),
    lab.Stands("felt", "the robot that feels"),
    lab.Bound("the feet slide", "slid", low=20.0),
    lab.Bound("the CoP outruns the floor", "cop", low=80.0, high=110.0),
    lab.Bound("told, the CoM stays above the feet", "told", high=1.0),
    lab.Bound("by feel, it lags", "felt", low=5.0, high=30.0),
)
