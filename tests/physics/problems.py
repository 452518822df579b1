"""The contact problem of a recorded tick, put together again from its parts."""

from __future__ import annotations

from dataclasses import dataclass

import clarabel
import numpy as np
from scipy import sparse

from momentum_lab.physics.contact import Contacts, ContactSolution, solve_contact
from momentum_lab.physics.ground import Ground
from momentum_lab.physics.push import apply_pushes
from momentum_lab.physics.touch import SolePoints
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import Dynamics, State
from momentum_lab.session import Session


@dataclass(frozen=True)
class Problem:
    """One contact problem of soles on level ground.

    Attributes:
        dynamics: the state at the start of the step.
        mass_matrix: H (nv, nv), joint limits included.
        free_impulse: impulse of everything but contact (nv,).
        contacts: the corners of all soles.
        feet: which foot each corner belongs to (n,).
        corners: positions of the corners in the world (n, 3), m.
        timestep: s.
    """

    dynamics: Dynamics
    mass_matrix: np.ndarray
    free_impulse: np.ndarray
    contacts: Contacts
    feet: np.ndarray
    corners: np.ndarray
    timestep: float

    @property
    def closing_speed(self) -> np.ndarray:
        """Speed at which each gap may close (n,): to the ground within the step, out of it gently."""
        gap = self.contacts.gap
        speed = [
            g / self.timestep if g > -0.01 * self.timestep else max(min(50 * g, -0.01), -0.2) for g in gap
        ]
        return np.array(speed)

    @property
    def free_velocity(self) -> np.ndarray:
        """Velocity at the end of a step without contact (nv,)."""
        return self.dynamics.state.v + np.linalg.solve(self.mass_matrix, self.free_impulse)

    def solve(self) -> ContactSolution:
        return solve_contact(
            self.mass_matrix, self.free_impulse, self.dynamics.state.v, self.contacts, self.timestep
        )

    def foot_wrenches(self, impulse: np.ndarray) -> np.ndarray:
        """Wrenches about the sole origins (F, 6), N and N m, from corner impulses (n, 3) in world axes."""
        force = impulse / self.timestep
        wrenches = np.zeros((len(self.dynamics.sole_position), 6))
        for foot, corner, f in zip(self.feet, self.corners, force, strict=True):
            wrenches[foot, :3] += f
            wrenches[foot, 3:] += np.cross(corner - self.dynamics.sole_position[foot], f)
        return wrenches


def problem_at(session: Session, row: int) -> Problem:
    """The contact problem of one recorded tick."""
    robot, record, dt = session.robot, session.recording, session.scenario.timestep
    state = State(record.column("q")[row], record.column("v")[row])
    dynamics = robot.at(state)
    time = float(record.column("time")[row])
    push = apply_pushes(robot, robot.model.createData(), dynamics, session.pushes, time, dt)
    force = -dynamics.nonlinear_effects
    force[6:] += record.column("torque")[row]
    if push is not None:
        force += push.generalized
    friction = robot.spec.friction if session.scenario.friction is None else session.scenario.friction
    return problem_of(robot, dynamics, force, friction, dt)


def problem_of(
    robot: RobotModel, dynamics: Dynamics, force: np.ndarray, friction: float, dt: float
) -> Problem:
    """The contact problem of a state under generalized forces (nv,) without contact."""
    touches = SolePoints(robot, Ground.level(2, friction), dt).touches(dynamics, 0.0)
    feet = np.repeat(touches.foot, 4)
    mass_matrix, impulse = with_joint_limits(robot, dynamics, dt * force, dt)
    return Problem(dynamics, mass_matrix, impulse, touches.contacts, feet, touches.position, dt)


def with_joint_limits(
    robot: RobotModel, dynamics: Dynamics, impulse: np.ndarray, dt: float
) -> tuple[np.ndarray, np.ndarray]:
    """Mass matrix and free impulse with a backward Euler spring and damper at every joint beyond its limit.

    H (v+ - v) = p - dt k (e + dt v+) - dt d v+, d = 2 k T with T = 10 ms, and k the larger of H_jj / T^2 and the
    motor's torque over 0.02 rad.
    """
    angle = dynamics.state.q[7:]
    excess = np.zeros(robot.nv)
    excess[6:] = angle - np.clip(angle, robot.position_lower, robot.position_upper)
    motor = np.concatenate([np.zeros(6), robot.effort_limit / 0.02])
    stiffness = np.where(excess != 0.0, np.maximum(np.diag(dynamics.mass_matrix) / 0.01**2, motor), 0.0)
    added = dt * 0.02 * stiffness + dt**2 * stiffness
    return (
        dynamics.mass_matrix + np.diag(added),
        impulse - dt * stiffness * excess - added * dynamics.state.v,
    )


def least_contact_energy(delassus: np.ndarray, drift: np.ndarray, friction: np.ndarray) -> np.ndarray:
    """The impulses (n, 3) in the friction cones that minimise 1/2 l^T W l + g^T l, by an interior point method.

    While no point slides this convex program is the Signorini-Coulomb problem.
    """
    size = drift.size
    cone_rows = [np.array([[0, 0, mu], [1, 0, 0], [0, 1, 0]], dtype=float) for mu in friction]
    settings = clarabel.DefaultSettings()
    settings.verbose = False
    settings.tol_gap_abs = settings.tol_gap_rel = settings.tol_feas = 1e-12
    # Impulses of a millisecond are small numbers; as forces they are of the size the tolerances expect.
    solver = clarabel.DefaultSolver(
        sparse.csc_matrix(np.triu(delassus)),
        drift,
        sparse.csc_matrix(-sparse.block_diag(cone_rows)),
        np.zeros(size),
        [clarabel.SecondOrderConeT(3) for _ in friction],
        settings,
    )
    return np.array(solver.solve().x).reshape(-1, 3)
