"""What the ground can do

A robot is pushed forward and let go. Its motors only move its own parts against each other: so what stops it?
"""

import numpy as np

import momentum_lab.lesson as lab
from momentum_lab.experiments.measured import ground_force, push_end, times
from momentum_lab.lesson import quantities as q

RUNS = {"push": lab.Run("fig1", {"seconds": 2.0})}
AFTER = 0.35  # when the push is over, s


def brake(session):
    """The ground's mean force forward, in the tenth of a second after the push, N."""
    late = times(session) - push_end(session)
    return ground_force(session)[(late > 0.0) & (late < 0.1), 0].mean()


def speed(session):
    """Of the CoM at the end, mm/s."""
    return 1e3 * np.linalg.norm(session.recording.column("com_velocity")[-1])


MEASURES = {
    "push": lab.of("push", q.push_force, "N"),
    "weight": lab.of("push", q.weight, "N"),
    "carried": lab.of("push", lambda s: ground_force(s)[0, 2], "N"),
    "brake": lab.of("push", brake, "N"),
    "size": lab.of("push", lambda s: abs(brake(s)), "N"),
    "upward": lab.of("push", lambda s: 100.0 * (ground_force(s)[:, 2] > 0.0).mean(), "%"),
    "speed": lab.of("push", speed, "mm/s"),
}

STEPS = (
    lab.Prose(
        "The robot weighs {weight}. While it stands still, the ground carries just that: {carried}, straight "
        "up, the green arrow under its feet."
    ),
    lab.Choice(
        "A push of {push} from behind, a little from the right, has just ended. Which way does the ground push "
        "the feet?",
        (
            lab.Option("Straight up, as before", lambda m: abs(m["brake"]) < 1.0),
            lab.Option("Up and forward: the robot is still going there", lambda m: m["brake"] >= 1.0),
            lab.Option("Up and backward", lambda m: m["brake"] <= -1.0),
        ),
    ),
    lab.Number(
        "How hard does the ground then push along the floor? Forward counts as positive.", "brake", -200, 200
    ),
    lab.Play(
        "Slow time down, and watch the green arrow lean.", "push", ("push", "push direction"), view="Side"
    ),
    lab.Compare(
        "The arrow leans back: {size} against the motion. It never pulls down: it points up {upward} of the time.",
        ("brake", "upward"),
    ),
    lab.Explain(
        "The CoM is the centre of mass; mass times its speed is the linear momentum. A dot over a letter means "
        "how fast it changes. Left: the motion of all parts. Right: the force of the ground. They agree "
        "(Eq. 2), so nothing else stops the robot.",
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
        "Where the ground pushes matters, too. A force that passes by the CoM has a lever and turns the body. "
        "How much the body turns about its CoM is its angular momentum; lever times force is how fast that "
        "changes (Eq. 1).",
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
        "So one force does two things: it stops the CoM, and it turns the body. To balance is to share it "
        "between them."
    ),
)

CLAIMS = (
    lab.Stands("push"),
    lab.Bound("after the push the ground brakes", "brake", high=-5.0),
    lab.Bound("the ground only pushes", "upward", low=100.0),
    lab.Bound("at the end it stands still", "speed", high=20.0),
)
