"""Eqs. 52 to 60: bounds of the CoP as rows over the accelerations of all links (section 5.2)."""

from __future__ import annotations

import numpy as np
import pinocchio as pin

from momentum_lab.experiments.equations.cop import case_of
from momentum_lab.experiments.equations.equation import Equation, Residual
from momentum_lab.experiments.equations.scenes import worst
from momentum_lab.momentum.ground import cop_from_momentum_rate
from momentum_lab.momentum.segment_cop import Edges, centroidal_rows, segment_rows
from momentum_lab.momentum.segments import segments
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import State


def _bounds(robot: RobotModel, seed: int) -> float:
    """H_r y_r'' - K_r against f_z times the CoP's distance from the edges (Eq. 21), in m g."""
    case = case_of(robot, seed)
    rows, limit = segment_rows(case.links, case.edges, case.ground)
    com = case.scene.dynamics.com_in_world
    cop = cop_from_momentum_rate(case.rate, com, robot.mass, case.ground)
    expected = case.normal_force * (case.edges.normal @ cop - case.edges.offset)
    found = rows @ case.links.stacked_acceleration(case.scene.acceleration) - limit
    return worst(found - expected) / case.scene.weight


def _rows(robot: RobotModel, seed: int) -> float:
    """H_r J_r against the same rows made of A_G, in m g."""
    case = case_of(robot, seed)
    dynamics = case.scene.dynamics
    rows, _ = segment_rows(case.links, case.edges, case.ground)
    expected, _ = centroidal_rows(
        dynamics.centroidal_map,
        dynamics.centroidal_bias,
        dynamics.com_in_world,
        robot.mass,
        case.edges,
        case.ground,
    )
    return worst(rows @ case.links.stacked_jacobian() - expected) / case.scene.weight


def _order(robot: RobotModel, seed: int) -> float:
    """Every block of y_r'' against Pinocchio's accelerations of the links."""
    case = case_of(robot, seed)
    data, model = case.scene.kinematics(), robot.model
    expected = []
    for i in range(1, model.njoints):
        if model.inertias[i].mass > 0.0:
            frame = data.oMi[i]
            spin, turning = frame.rotation @ data.v[i].angular, frame.rotation @ data.a[i].angular
            lever = frame.rotation @ model.inertias[i].lever
            world = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
            origin = pin.getClassicalAcceleration(model, data, i, world).linear
            com = origin + np.cross(turning, lever) + np.cross(spin, np.cross(spin, lever))
            expected.append(np.concatenate((com, turning)))
    found = case.links.stacked_acceleration(case.scene.acceleration)
    return worst(found - np.array(expected).T.ravel())


def _limits(robot: RobotModel, seed: int) -> float:
    """K_r of a robot at rest against its weight times the CoM's distance from the edges, in m g."""
    case = case_of(robot, seed)
    still = segments(robot, State(case.scene.state.q, np.zeros(robot.nv)))
    _, limit = segment_rows(still, case.edges, case.ground)
    com = case.scene.dynamics.com_in_world[:2]
    return worst(limit / case.scene.weight + case.edges.normal @ com - case.edges.offset)


def _edge(number: int) -> Residual:
    """One edge moved outwards by 1 cm: its row has to lose f_z times that way, the others nothing, in m g."""

    def residual(robot: RobotModel, seed: int) -> float:
        case, way = case_of(robot, seed), np.zeros(4)
        way[number] = 0.01
        acceleration = case.links.stacked_acceleration(case.scene.acceleration)
        (rows, limit), (moved_rows, moved_limit) = (
            segment_rows(case.links, Edges(case.edges.normal, offset), case.ground)
            for offset in (case.edges.offset, case.edges.offset + way)
        )
        lost = (rows - moved_rows) @ acceleration - (limit - moved_limit)
        return worst(lost - case.normal_force * way) / case.scene.weight

    return residual


def _accelerations(robot: RobotModel, seed: int) -> float:
    """J_r a + Psi_r against central differences of J_r v."""
    case = case_of(robot, seed)

    def velocities(state: State) -> np.ndarray:
        return segments(robot, state).stacked_jacobian() @ state.v

    found = case.links.stacked_acceleration(case.scene.acceleration)
    return worst(found - case.scene.rate(velocities))


_ROWS = "momentum.segment_cop.segment_rows"
_STACKED = "momentum.segments.Segments.stacked_acceleration"
_PRINTED = "tests/momentum/test_segment_cop.py::test_the_printed_rows_of_equation_53"
_LINKS = "tests/momentum/test_segments.py::test_accelerations_are_differences_of_velocities"
_BOUNDED = "tests/control/test_slack_qp.py::TestOneTick::test_the_cop_bounds_of_all_links_hold"
_SIZE = (
    "blocks have one entry per link with mass; a fixed foot counts in the total mass and K_r or in neither"
)
_UNIT = "m g m"

EQUATIONS = (
    Equation(
        52,
        "H_r y_r'' <= K_r",
        _ROWS,
        _BOUNDED,
        _bounds,
        1e-9,
        _UNIT,
        "needs f_z > 0 beside it: the bounds were multiplied by the normal force",
    ),
    Equation(
        53,
        "H_r = [-m o r_z, 0, m o r_x - x_max, 0, -I_y; ...]",
        _ROWS,
        _PRINTED,
        _rows,
        1e-9,
        _UNIT,
        f"its dot is element by element, that of Eq. 55 a sum; {_SIZE}",
    ),
    Equation(54, "y_r'' = [r_x''; r_y''; r_z''; w_x'; w_y']", _STACKED, _LINKS, _order, 1e-9, "SI", _SIZE),
    Equation(
        55,
        "K_r = [g (m_tot x_max - m^T r_x); ...]",
        _ROWS,
        _PRINTED,
        _limits,
        1e-10,
        "m",
        f"its dot is the inner product m^T r, transposes are void; {_SIZE}",
    ),
    *(
        Equation(
            56 + number, f"{name} m^T of Eq. 53 from {name}", _ROWS, _PRINTED, _edge(number), 1e-11, _UNIT
        )
        for number, name in enumerate(("x_max", "x_min", "y_max", "y_min"))
    ),
    Equation(60, "y_r'' = J_r q'' + Psi_r", _STACKED, _LINKS, _accelerations, 1e-5, "SI"),
)
