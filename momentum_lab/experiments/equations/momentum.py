"""Eqs. 12 to 20: the centroidal momentum, its map and its rate (section 3.3)."""

from __future__ import annotations

import numpy as np
import pinocchio as pin

from momentum_lab.experiments.equations.equation import Equation
from momentum_lab.experiments.equations.links import by_links
from momentum_lab.experiments.equations.scenes import flying, worst
from momentum_lab.momentum.centroidal import momentum_rate, motion_transform
from momentum_lab.momentum.wrench import skew
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import State


def _momentum_about_com(robot: RobotModel, seed: int) -> float:
    """Against sum m_i dc_i and sum (c_i - r_G) x m_i dc_i + I_i omega_i, in the world."""
    _, links, data = by_links(robot, seed)
    total = np.zeros(6)
    for i in range(1, robot.model.njoints):
        body, place = robot.model.inertias[i], data.oMi[i]
        spin = place.rotation @ data.v[i].angular
        lever = place.rotation @ body.lever
        linear = body.mass * (place.rotation @ data.v[i].linear + np.cross(spin, lever))
        own = place.rotation @ body.inertia @ place.rotation.T @ spin
        total[:3] += linear
        total[3:] += np.cross(place.translation + lever - links.com_in_world, linear) + own
    return worst(links.momentum - total)


def _projection(robot: RobotModel, seed: int) -> float:
    """A rigid body turning about the CoM moves each link's origin by v + omega x (o_i - r_G), in link axes."""
    scene, links, data = by_links(robot, seed)
    v, omega = scene.rng.normal(size=(2, 3))
    found = (links.projection @ np.concatenate((v, omega))).reshape(-1, 2, 3)
    frames = [data.oMi[i] for i in range(1, robot.model.njoints)]
    at_origins = [v + np.cross(omega, frame.translation - links.com_in_world) for frame in frames]
    expected = [
        np.array([move, omega]) @ frame.rotation for frame, move in zip(frames, at_origins, strict=True)
    ]
    by_hand = motion_transform(frames[0].rotation.T, frames[0].translation - links.com_in_world)
    return worst(found - np.array(expected), links.projection[:6] - by_hand)


def _centre_of_mass(robot: RobotModel, seed: int) -> float:
    """Against the first moment of mass in the base rows of the mass matrix: m S(c) of the whole robot."""
    scene, links, data = by_links(robot, seed)
    base = data.oMi[1]
    moment = skew(base.rotation.T @ (links.com_in_world - base.translation)) * robot.mass
    return worst(scene.dynamics.mass_matrix[3:6, :3] - moment) / robot.mass


def _momentum_map(robot: RobotModel, seed: int) -> float:
    """A_G v of the tick's recursion against the sum over the links."""
    scene, links, _ = by_links(robot, seed)
    return worst(scene.dynamics.centroidal_map @ scene.state.v - links.momentum)


def _map_of_links(robot: RobotModel, seed: int) -> float:
    """X_G^T I J against the base rows of the mass matrix, taken about the CoM."""
    scene, links, data = by_links(robot, seed)
    about_com = pin.SE3(data.oMi[1].rotation, data.oMi[1].translation - links.com_in_world)
    expected = about_com.toDualActionMatrix() @ scene.dynamics.mass_matrix[:6]
    return worst(links.centroidal_map - expected)


def _system_map(robot: RobotModel, seed: int) -> float:
    """A = I J, row by row of each link, through X_G^T to A_G v: against the tick's recursion."""
    scene, links, _ = by_links(robot, seed)
    jacobian = links.system_jacobian.reshape(len(links.inertias), 6, -1)
    system = (links.inertias @ jacobian).reshape(-1, robot.nv)
    return worst(
        system @ scene.state.v - links.momenta.ravel(),
        links.projection.T @ system - scene.dynamics.centroidal_map,
    )


def _rate(robot: RobotModel, seed: int) -> float:
    """Against central differences of h_G along the motion."""
    scene = flying(robot, seed)

    def momentum(state: State) -> np.ndarray:
        return robot.at(state).momentum

    return worst(momentum_rate(scene.dynamics, scene.acceleration) - scene.rate(momentum))


_LINKS = "momentum.centroidal.link_by_link"
_AT = "robot.model.RobotModel.at"
_TEST = "tests/momentum/test_centroidal.py::test_"

EQUATIONS = (
    Equation(
        12,
        "h_G = sum X_Gi^T h_i",
        _LINKS,
        f"{_TEST}momentum_by_elementary_mechanics",
        _momentum_about_com,
        1e-10,
        "SI",
    ),
    Equation(
        13,
        "X_Gi = [[R^T, -R^T S(o_i - r_G)], [0, R^T]]",
        _LINKS,
        f"{_TEST}momentum_by_elementary_mechanics",
        _projection,
        1e-12,
        "SI",
        "the caption of Fig. 3 means Eq. 12 where it names Eq. 13, which defines the projection",
    ),
    Equation(
        14,
        "r_G = sum m_i c_i / sum m_i",
        _LINKS,
        f"{_TEST}centre_of_mass",
        _centre_of_mass,
        1e-12,
        "m",
    ),
    Equation(
        15,
        "h_G = A_G q'",
        _AT,
        f"{_TEST}momentum_three_ways",
        _momentum_map,
        1e-10,
        "SI",
        "equals Kajita's matrix only with base columns turned to world axes, not by swapping rows alone",
    ),
    *(
        Equation(number, says, _LINKS, f"{_TEST}centroidal_map_by_both_roads", residual, 1e-10, "SI")
        for number, says, residual in (
            (16, "A = I J", _system_map),
            (17, "A = [A_1; A_2; ...; A_N], A_i = I_i J_i", _system_map),
            (18, "h_G = X_G^T A q'", _system_map),
            (19, "A_G = X_G^T A = X_G^T I J", _map_of_links),
        )
    ),
    Equation(
        20,
        "h_G' = A_G q'' + A_G' q'",
        "momentum.centroidal.momentum_rate",
        f"{_TEST}bias_by_finite_differences",
        _rate,
        1e-5,
        "SI",
        "inverse dynamics at q'' = 0 gives A_G' q' only without gravity, which is an external force here",
    ),
)
