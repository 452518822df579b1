"""Ice, slopes, a moving floor

The robot does nothing wrong; the ground is the trouble. What can it mend by moving, and what can it not?
"""

import numpy as np

import momentum_lab.lesson as lab
from momentum_lab.lesson import quantities as q

SLOPE = {"roll_deg": 10.0}
TURN = 3.0  # the bus is farthest forward, s
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
    return np.linalg.norm(force - force @ normal * normal) / (force @ normal)


def slid(session):
    """How far the feet have moved on the ground within half a second, mm."""
    place = session.recording.column("sole_pose")[..., :3]
    return 1e3 * np.linalg.norm(place[500] - place[0], axis=1).max()


def sway(name):
    """Largest way of a point along x once the floor sways fully, from its middle, mm."""
    return lambda s: 500.0 * np.ptp(s.recording.column(name)[3000:, ..., 0])


def lag(session):
    """How far the CoM gets from the middle of its feet, mm."""
    over = session.recording.column("com")[:, 0] - session.recording.column("sole_pose")[..., 0].mean(axis=1)
    return 1e3 * np.abs(over - over[0]).max()


MEASURES = {
    "tilt": lab.of("slope", lambda s: s.scenario.ground[0].roll_deg, "degrees"),
    "needed": lab.of("slope", friction_used, "", ".3f"),
    "firm_friction": lab.of("slope", lambda s: s.ground.friction(0.0)[0], "", ".1f"),
    "icy_friction": lab.of("icy", lambda s: s.ground.friction(0.0)[0], "", ".1f"),
    "icy": lab.fate("icy"),
    "slid": lab.of("icy", slid, "mm"),
    "floor": lab.of("told", sway("ground_pose"), "mm"),
    "cop": lab.of("told", sway("cop_measured"), "mm"),
    "there": lab.at("told", TURN, lambda s: 1e3 * q.recorded("ground_pose", 0, 0)(s), "mm"),
    "force": lab.at("told", TURN, lambda s: -q.BRAKING.values(s), "N"),
    "ahead": lab.at("told", TURN, lambda s: 1e3 * (q.COP_X.values(s) - q.COM_X.values(s)), "mm"),
    "told": lab.of("told", lag, "mm", ".1f"),
    "felt": lab.of("felt", lag, "mm", ".1f"),
}

STEPS = (
    lab.Prose(
        "The ground can only push. Along itself it holds no harder than its friction times that push. Two robots "
        "stand on slopes of {tilt}: one with a friction of {firm_friction}, one on ice with {icy_friction}."
    ),
    lab.Number("How much friction does it take to stand on such a slope, at the least?", "needed", 0.0, 1.0),
    lab.Play("Watch the feet.", "slope", ("push", "push direction"), beside="icy", view="Front"),
    lab.Compare(
        "Standing took {needed}, the tangent of the slope. The robot on ice {icy}: its feet slid {slid} in half "
        "a second. No controller can mend that: to carry the weight the force must point up, and on ice it "
        "cannot.",
        ("needed", "icy", "slid"),
    ),
    lab.Number(
        "Now the floor is level, but sways by {floor} each way, like a bus. How far does the CoP sway, if the "
        "CoM stays above the feet?",
        "cop",
        0.0,
        200.0,
    ),
    lab.Choice(
        "One robot is told how the bus will move, the other only feels it. Whose CoM strays farther from its feet?",
        (
            lab.Option("The one that is told", lambda m: m["told"] > 2.0 * m["felt"]),
            lab.Option("The one that feels", lambda m: m["felt"] > 2.0 * m["told"]),
            lab.Option("Both alike", lambda m: 0.5 <= m["told"] / m["felt"] <= 2.0),
        ),
    ),
    lab.Play("Watch CoP, CoM and feet.", "told", ("linear_stiffness",), beside="felt", view="Whole robot"),
    lab.Compare(
        "The CoP swayed by {cop}, the floor by {floor}. Told, the CoM strayed by {told}; by feel alone, by {felt}.",
        ("cop", "told", "felt"),
    ),
    lab.Explain(
        "Here the bus is farthest forward and turns back. To turn back with it, the CoM needs a force of {force} "
        "backward. That takes a CoP {ahead} in front of it (Eq. 21). A foot is only so long: a wilder bus "
        "takes a step, or a handrail.",
        "told",
        TURN,
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
    *(lab.Stands(label, f"the robot of the run {label}") for label in ("slope", "told", "felt")),
    lab.Falls("icy", "the robot on the icy slope"),
    lab.Bound("the feet slide", "slid", low=20.0),
    lab.Bound("the CoP outruns the floor", "cop", low=80.0, high=110.0),
    lab.Bound("the bus is farthest forward", "there", low=49.0),
    lab.Bound("told, the CoM stays above the feet", "told", high=1.0),
    lab.Bound("by feel, it lags", "felt", low=5.0, high=30.0),
)
