"""What the ground can do

A robot is pushed forward and let go. Its motors only move its own parts against each other: so what stops it?
"""

import numpy as np

import momentum_lab.lesson as lab
from momentum_lab.experiments.measured import ground_force, push_end, times
from momentum_lab.lesson import quantities as q

RUNS = {"push": lab.Run("fig1", {"seconds": 2.0})}
AFTER = 0.35  # when the push is over, s


def after_push(session, values):
    """The part of an array that belongs to the tenth of a second after the push."""
    clock = times(session)[: len(values)]
    return values[(clock > push_end(session)) & (clock < push_end(session) + 0.1)]


def mean_force(runs):
    return float(after_push(runs["push"], ground_force(runs["push"]))[:, 0].mean())


def share_upward(runs):
    force = ground_force(runs["push"])
    return 100.0 * float((force[:, 2] > 0.0).mean())


MEASURES = {
    "push": lab.Measure(lambda runs: runs["push"].pushes[0].force, "N"),
    "weight": lab.Measure(lambda runs: runs["push"].robot.mass * 9.81, "N"),
    "carried": lab.Measure(lambda runs: float(ground_force(runs["push"])[0, 2]), "N"),
    "brake": lab.Measure(mean_force, "N"),
    "upward": lab.Measure(share_upward, "%"),
    "speed": lab.Measure(
        lambda runs: 1e3 * float(np.linalg.norm(runs["push"].recording.column("com_velocity")[-1])), "mm/s"
    ),
}

STEPS = (
    lab.Prose("The robot weighs {weight}, and standing still the ground carries exactly that: {carried}."),
    lab.Choice(
        "A push of {push}, mostly from behind, ends. Just after it, which way does the ground push the feet?",
        (
            lab.Option("Straight up, as before", lambda m: abs(m["brake"]) < 1.0),
            lab.Option("Up and forward: the robot is still going there", lambda m: m["brake"] >= 1.0),
            lab.Option("Up and backward", lambda m: m["brake"] <= -1.0),
        ),
    ),
    lab.Number(
        "How large is the horizontal part, along the push (forward counts as positive)?", "brake", -200, 200
    ),
    lab.Play("Push, and watch the arrow under the feet lean.", "push", ("push", "push direction")),
    lab.Compare(
        "The arrow leans back, {brake} on average. It never pulls: it points up on {upward} of all ticks.",
        ("brake", "upward"),
    ),
    lab.Explain(
        "The sum of the forces is the rate of linear momentum (Eq. 2). Here is the motion of all links on the "
        "left, the ground on the right: nothing else is left to stop the robot.",
        "push",
        AFTER,
        lab.Equation(
            "dl_x = f_x",
            {"dl_x": q.BRAKING, "f_x": q.FORCE_X},
            within=5.0,
            unit="N",
            share=0.95,
            since=0.31,
        ),
    ),
    lab.Explain(
        "Where the ground pushes matters too. About the CoM its force has a lever, and that turns the body: the "
        "rate of angular momentum (Eq. 1).",
        "push",
        AFTER,
        lab.Equation(
            "dk_y = (r_x - p_x) * f_z - r_z * f_x",
            {
                "dk_y": q.TURNING,
                "r_x": q.COM_X,
                "r_z": q.COM_Z,
                "p_x": q.COP_X,
                "f_x": q.FORCE_X,
                "f_z": q.FORCE_Z,
            },
            within=1.0,
            unit="N m",
            share=0.95,
            since=0.31,
        ),
    ),
    lab.Prose(
        "Six numbers of the ground, six rates of momentum: whoever balances, bargains with the ground."
    ),
)

CLAIMS = (
    lab.Stands("push"),
    lab.Bound("after the push the ground brakes", "brake", high=-5.0),
    lab.Bound("the ground only pushes", "upward", low=100.0),
    lab.Bound("at the end it stands still", "speed", high=20.0),
)
