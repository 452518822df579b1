"""Eqs. 3 to 11: velocities, inertias and momenta of the links (sections 3.1 and 3.2)."""

from __future__ import annotations

import numpy as np
import pinocchio as pin

from momentum_lab.experiments.equations.equation import Equation
from momentum_lab.experiments.equations.scenes import Scene, flying, worst
from momentum_lab.momentum.centroidal import LinkMomenta, link_by_link
from momentum_lab.robot.model import RobotModel


def by_links(robot: RobotModel, seed: int) -> tuple[Scene, LinkMomenta, pin.Data]:
    """A robot in flight, its stages of the momentum link by link, and Pinocchio's own kinematics."""
    scene = flying(robot, seed)
    return scene, link_by_link(robot, scene.state), scene.kinematics()


def _link_velocities(robot: RobotModel, seed: int) -> float:
    """Against Pinocchio's velocities of the joints."""
    _, links, data = by_links(robot, seed)
    return worst(links.velocities - np.array([data.v[i].vector for i in range(1, robot.model.njoints)]))


def _transforms(robot: RobotModel, seed: int) -> float:
    """Against Pinocchio's action matrices."""
    _, links, data = by_links(robot, seed)
    expected = [data.liMi[i].toActionMatrixInverse() for i in range(1, robot.model.njoints)]
    return worst(links.transforms - np.array(expected))


def _system_jacobian(robot: RobotModel, seed: int) -> float:
    """J against Pinocchio's link Jacobians, stacked, and J v against its link velocities."""
    scene, links, data = by_links(robot, seed)
    model = robot.model
    pin.computeJointJacobians(model, data, scene.state.q)
    joints = range(1, model.njoints)
    stacked = [pin.getJointJacobian(model, data, i, pin.ReferenceFrame.LOCAL) for i in joints]
    velocities = np.concatenate([data.v[i].vector for i in joints])
    return worst(
        links.system_jacobian - np.concatenate(stacked), links.system_jacobian @ scene.state.v - velocities
    )


def _link_momenta(robot: RobotModel, seed: int) -> float:
    """Against l = m v_cm and k = c x l + I_cm omega."""
    _, links, data = by_links(robot, seed)
    expected = []
    for i in range(1, robot.model.njoints):
        body, velocity = robot.model.inertias[i], data.v[i]
        linear = body.mass * (velocity.linear + np.cross(velocity.angular, body.lever))
        angular = np.cross(body.lever, linear) + body.inertia @ velocity.angular
        expected.append(np.concatenate((linear, angular)))
    return worst(links.momenta - np.array(expected))


def _link_inertias(robot: RobotModel, seed: int) -> float:
    """The kinetic energy of a random velocity against that of its parts, m v_cm^2 / 2 + omega . I_cm omega / 2."""
    scene, links, _ = by_links(robot, seed)
    differences = []
    for inertia, body in zip(links.inertias, list(robot.model.inertias)[1:], strict=True):
        v, omega = scene.rng.normal(size=(2, 3))
        at_com = v + np.cross(omega, body.lever)
        parts = body.mass * at_com @ at_com + omega @ body.inertia @ omega
        twist = np.concatenate((v, omega))
        differences.append(0.5 * (twist @ inertia @ twist - parts))
    return worst(np.array(differences))


def _parallel_axes(robot: RobotModel, seed: int) -> float:
    """Against turning each link about a parallel axis through its CoM, m (|c|^2 n.n - (c.n)^2) + n . I_cm n."""
    scene, links, _ = by_links(robot, seed)
    differences = []
    for inertia, body in zip(links.inertias, list(robot.model.inertias)[1:], strict=True):
        axis, c = scene.rng.normal(size=3), body.lever
        expected = axis @ body.inertia @ axis + body.mass * (c @ c * (axis @ axis) - (c @ axis) ** 2)
        differences.append(axis @ inertia[3:, 3:] @ axis - expected)
    return worst(np.array(differences))


def _system_momentum(robot: RobotModel, seed: int) -> float:
    """All link momenta at once against Pinocchio's own inertia times velocity, link by link."""
    _, links, data = by_links(robot, seed)
    expected = [(robot.model.inertias[i] * data.v[i]).vector for i in range(1, robot.model.njoints)]
    return worst(links.momenta - np.array(expected))


_LINKS = "momentum.centroidal.link_by_link"
_TEST = "tests/momentum/test_centroidal.py::test_"

EQUATIONS = (
    Equation(
        3,
        "v_i = X_i v_p(i) + Phi_i q_i'",
        _LINKS,
        f"{_TEST}link_velocities",
        _link_velocities,
        1e-11,
        "SI",
    ),
    Equation(
        4,
        "X_i = [[E, -E S(p)], [0, E]]",
        "momentum.centroidal.motion_transform",
        f"{_TEST}link_transforms_in_the_chapters_order",
        _transforms,
        1e-12,
        "SI",
    ),
    *(
        Equation(number, says, _LINKS, f"{_TEST}system_jacobian", _system_jacobian, 1e-11, "SI")
        for number, says in (
            (5, "v = J q', all links at once"),
            (6, "v = [v_1; v_2; ...; v_N]"),
            (7, "J = [J_1; J_2; ...; J_N]"),
        )
    ),
    Equation(8, "h_i = I_i v_i", _LINKS, f"{_TEST}link_momenta", _link_momenta, 1e-11, "SI"),
    Equation(
        9,
        "I_i = [[m 1, m S(c)^T], [m S(c), I_o]]",
        "momentum.centroidal.spatial_inertia",
        f"{_TEST}link_inertias_in_the_chapters_order",
        _link_inertias,
        1e-11,
        "J",
    ),
    Equation(
        10,
        "I_o = I_cm + m S(c) S(c)^T",
        "momentum.centroidal.spatial_inertia",
        f"{_TEST}link_inertias_in_the_chapters_order",
        _parallel_axes,
        1e-12,
        "kg m^2",
    ),
    Equation(
        11,
        "h = blkdiag(I_i) v",
        _LINKS,
        f"{_TEST}link_momenta",
        _system_momentum,
        1e-11,
        "SI",
    ),
)
