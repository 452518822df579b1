"""When momentum is not enough

The ground gave all it can, and the robot falls. Where must the next foot go, and what can no momentum tell?
"""

import numpy as np
import pinocchio as pin

import momentum_lab.lesson as lab
from momentum_lab.experiments.measured import ground_force, push_end, times
from momentum_lab.lesson import quantities as q
from momentum_lab.robot.state import State

PUSH = (lab.Push(velocity_change=0.44, duration=0.1, start=0.2),)
RUNS = {"push": lab.Run("fig7", {"pushes": PUSH, "priority": 1.0, "seconds": 1.8})}
SWING, STEPS_OF_LOOP = 0.4, 400  # rad, and ticks in which the hip goes round


def toes(session):
    """The front edge of the feet, m."""
    return float(session.recording.column("sole_pose")[0, :, 0].mean() + session.robot.soles[0].upper[0])


def beyond(session, time):
    """How far in front of the toes the capture point is, mm; the push ends at 0.3 s."""
    tick = int(np.searchsorted(times(session), time))
    return 1e3 * float(session.recording.column("capture_point")[tick, 0] - toes(session))


def omega(session):
    """The pendulum's rate with the CoM as high as it is (n,), 1/s."""
    return np.sqrt(9.81 / session.recording.column("com")[:, 2])


def slope(session):
    """Rate of the capture point, from differences over a tick, m/s; while the ground carries its weight."""
    rate = np.diff(session.recording.column("capture_point")[:, 0]) / session.scenario.timestep
    light = ground_force(session)[:, 2] <= 0.9 * session.robot.mass * 9.81
    return rate[: int(np.flatnonzero(light & (times(session) > push_end(session)))[0])]


def turned_by_a_loop(session):
    """How far a hip that goes round in a circle turns a body without any momentum, degrees."""
    robot, where = session.robot, session.recording.column("q")[0].copy()
    kick, side = hip_joints(robot)
    start = pin.Quaternion(where[3:7]).toRotationMatrix()
    for phase in np.linspace(0.0, 2.0 * np.pi, STEPS_OF_LOOP, endpoint=False):
        rates = np.zeros(robot.nv)
        rates[kick], rates[side] = -SWING * np.sin(phase), SWING * np.cos(phase)
        centroidal = robot.at(State(where, np.zeros(robot.nv))).centroidal_map
        rates[:6] = -np.linalg.solve(centroidal[:, :6], centroidal[:, 6:] @ rates[6:])
        where = pin.integrate(robot.model, where, rates * 2.0 * np.pi / STEPS_OF_LOOP)
    turn = pin.Quaternion(where[3:7]).toRotationMatrix() @ start.T
    return float(np.degrees(np.linalg.norm(pin.log3(turn))))


def hip_joints(robot):
    """Columns of the right hip's joints that swing the leg forward and sideways."""
    talos, g1 = ("leg_right_3_joint", "leg_right_2_joint"), ("right_hip_pitch_joint", "right_hip_roll_joint")
    names = talos if robot.spec.name == "talos" else g1
    return [6 + robot.joint_names.index(name) for name in names]


MEASURES = {
    "push": lab.Measure(lambda runs: runs["push"].pushes[0].force, "N"),
    "fell": lab.Measure(lambda runs: runs["push"].fall.time, "s", ".2f"),
    "now": lab.Measure(lambda runs: beyond(runs["push"], 0.3), "mm"),
    "later": lab.Measure(lambda runs: beyond(runs["push"], 0.6), "mm"),
    "growth": lab.Measure(lambda runs: beyond(runs["push"], 0.6) / beyond(runs["push"], 0.3), "times", ".1f"),
    "swing": lab.Measure(lambda runs: float(np.degrees(SWING)), "degrees"),
    "turned": lab.Measure(lambda runs: turned_by_a_loop(runs["push"]), "degrees", ".1f"),
}

STEPS = (
    lab.Prose(
        "After a push of {push} the CoP goes to the toes and can go no farther. This robot keeps its body upright, "
        "and that is not enough: it needs a new foothold."
    ),
    lab.Number(
        "As the push ends, the capture point is {now} in front of the toes. And three tenths of a second later?",
        "later",
        0,
        500,
    ),
    lab.Choice(
        "Another question. In the air, without angular momentum, one hip leads its leg once around a circle of "
        "{swing}, back to where it began. Is the body turned?",
        (
            lab.Option("No: every joint is where it was", lambda m: m["turned"] < 1.0),
            lab.Option("Yes: the way there counts, not the end", lambda m: m["turned"] >= 1.0),
        ),
    ),
    lab.Play("Watch the capture point leave the feet.", "push", ("push", "priority")),
    lab.Compare(
        "The robot fell after {fell}. The capture point went from {now} to {later} in front of the toes, {growth} as "
        "far. The hip's circle turns the body by {turned}.",
        ("now", "later", "turned"),
    ),
    lab.Explain(
        "The capture point runs from the CMP. A foot set down on it, or beyond, could bring the CMP in front of it "
        "again and stop the robot; every tenth of a second that the step takes, it must go farther.",
        "push",
        0.4,
        lab.Equation(
            "dxi_x = omega * (xi_x - s_x)",
            {
                "dxi_x": lab.Symbol(slope, "m/s", "rate of the capture point", ".2f"),
                "omega": lab.Symbol(omega, "1/s", "the pendulum's rate", ".2f"),
                "xi_x": q.CAPTURE_X,
                "s_x": q.CMP_X,
            },
            within=0.06,
            unit="m/s",
            share=0.95,
            since=0.31,
        ),
    ),
    lab.Prose(
        "And what no one knows: the CoM is the place whose rate is the linear momentum. The angular momentum has no "
        "such place: it was zero all along the circle, and yet the body is turned by {turned}. A controller that "
        "knows momenta only lets the body drift; this lab holds the pelvis upright by a term of its own."
    ),
)

CLAIMS = (
    lab.Falls("push"),
    lab.Bound("as the push ends, the capture point is beyond the toes", "now", low=5.0),
    lab.Bound("the step that is needed grows", "growth", low=1.5),
    lab.Bound("the circle turns the body", "turned", low=1.0),
)
