"""Contact impulses by an interior point method: for a robot that lies on many bodies.

The laws of contact of a point with impulse (b, n) and velocity (u, s), normals last, are for kappa = 0

    W lambda + g = (u, s),    n s = kappa,    mu n psi + b . u = kappa,    mu n u + psi b = 0

with n, s >= 0, |b| <= mu n and |u| <= psi: it carries or lifts, and it sticks or slides with the speed psi against
its friction. From a large kappa and well inside the cones, Newton's method follows the solutions down to kappa = 0,
each step by a prediction for kappa = 0 and a correction. That takes a dozen systems of linear equations whatever
the points are, also where many share a load that few could carry; ADMM needs nearly a thousand iterations there.
"""

from __future__ import annotations

import math

import numpy as np

from momentum_lab.compiled import compiled
from momentum_lab.physics.elimination import eliminate, substitute

_MATRIX, _VECTOR, _STACK = "f8[:, ::1]", "f8[::1]", "f8[:, :, ::1]"

# Twice what any tick of a fall has needed; of a hundred thousand ticks, a few are not solved in any number.
_MAX_ITERATIONS = 40
# A step goes this part of the way to the boundary of the cones.
_OF_THE_WAY = 0.95
# A prediction that can be followed no farther than this tells nothing of how the products curve.
_SHORT = 0.1
# Points begin with at least this part of the largest speed.
_LEAST_SPEED = 0.01
# kappa ends at this part of the precision.
_LEAST_KAPPA = 0.02
# n s of all points, too: so nothing is left on a point that needs more than this, m/s, to close its gap in a step.
_HOVERING = 0.1


@compiled(f"{_MATRIX}({_MATRIX}, {_VECTOR})")
def beginning(delassus: np.ndarray, drift: np.ndarray) -> np.ndarray:
    """Points (n, 7) in the middle of their cones, with speeds and impulses of the size of the problem's."""
    points = np.zeros((len(drift) // 3, 7))
    speed = max(np.abs(drift).max(), 1e-9)
    impulse = speed * len(drift) / np.trace(delassus)
    for i in range(len(points)):
        points[i, 2], points[i, 6] = impulse, speed
        points[i, 5] = max(abs(drift[3 * i + 2]), _LEAST_SPEED * speed)
    return points


@compiled(f"{_MATRIX}({_MATRIX}, {_VECTOR}, {_MATRIX})")
def unbalanced(delassus: np.ndarray, drift: np.ndarray, points: np.ndarray) -> np.ndarray:
    """W lambda + g - (u, s) of the points (n, 3), m/s."""
    left = np.empty((len(points), 3))
    for i in range(len(points)):
        for axis in range(3):
            row = 3 * i + axis
            speed = drift[row] - points[i, 3 + axis]
            for j in range(len(points)):
                for k in range(3):
                    speed += delassus[row, 3 * j + k] * points[j, k]
            left[i, axis] = speed
    return left


@compiled(f"{_MATRIX}({_MATRIX}, {_VECTOR})")
def products(points: np.ndarray, friction: np.ndarray) -> np.ndarray:
    """Of each point or its change n s, mu n psi + b . u and mu n u + psi b (n, 4), N s m/s."""
    product = np.empty((len(points), 4))
    for i in range(len(points)):
        b1, b2, n, u1, u2, s, psi = points[i]
        edge = friction[i] * n
        product[i, 0] = n * s
        product[i, 1] = edge * psi + b1 * u1 + b2 * u2
        product[i, 2] = edge * u1 + psi * b1
        product[i, 3] = edge * u2 + psi * b2
    return product


@compiled(f"UniTuple({_STACK}, 2)({_MATRIX}, {_VECTOR})")
def eliminated(points: np.ndarray, friction: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """E and D of each point's d(u, s) = E w - D d(b, n), when its products are to change by w and psi is eliminated.

    The products' changes are G d(b, n) + (n ds, edge dpsi + b . du, edge du + b dpsi), edge = mu n; the last three
    give dpsi and du, and D = E G.

    Returns:
        E (n, 3, 4) and D (n, 3, 3).
    """
    answer, stiffness = np.zeros((len(points), 3, 4)), np.zeros((len(points), 3, 3))
    for i in range(len(points)):
        b1, b2, n, u1, u2, s, psi = points[i]
        edge = friction[i] * n
        inside = edge * edge - b1 * b1 - b2 * b2
        E, D = answer[i], stiffness[i]
        E[0, 1], E[0, 2], E[0, 3] = -b1 / inside, (1.0 + b1 * b1 / inside) / edge, b1 * b2 / inside / edge
        E[1, 1], E[1, 2], E[1, 3] = -b2 / inside, E[0, 3], (1.0 + b2 * b2 / inside) / edge
        E[2, 0] = 1.0 / n
        for axis in range(2):
            D[axis, 0] = E[axis, 1] * u1 + E[axis, 2] * psi
            D[axis, 1] = E[axis, 1] * u2 + E[axis, 3] * psi
            D[axis, 2] = friction[i] * (E[axis, 1] * psi + E[axis, 2] * u1 + E[axis, 3] * u2)
        D[2, 2] = s / n
    return answer, stiffness


@compiled(f"{_MATRIX}({_MATRIX}, {_STACK})")
def stiffened(delassus: np.ndarray, stiffness: np.ndarray) -> np.ndarray:
    """W with the blocks D (n, 3, 3) on its diagonal (3 n, 3 n)."""
    matrix = delassus.copy()
    for i in range(len(stiffness)):
        for row in range(3):
            for column in range(3):
                matrix[3 * i + row, 3 * i + column] += stiffness[i, row, column]
    return matrix


@compiled(f"{_MATRIX}({_MATRIX}, {_MATRIX}, i8[::1], {_MATRIX}, {_STACK}, {_MATRIX}, {_VECTOR}, {_MATRIX})")
def newton(
    delassus: np.ndarray,
    factors: np.ndarray,
    pivots: np.ndarray,
    left: np.ndarray,
    answer: np.ndarray,
    points: np.ndarray,
    friction: np.ndarray,
    wanted: np.ndarray,
) -> np.ndarray:
    """Changes of the points (n, 7) that balance velocities and change products as wanted, to first order.

    (W + D) d lambda = E w - left, then d(u, s) = W d lambda + left, and d psi from the second product.

    Args:
        delassus: W (3 n, 3 n).
        factors: of W + D (3 n, 3 n).
        pivots: theirs, see `eliminate` (3 n,).
        left: W lambda + g - (u, s) (n, 3).
        answer: E (n, 3, 4).
        points: (n, 7).
        friction: mu (n,).
        wanted: w (n, 4).
    """
    impulse = -left
    for i in range(len(points)):
        for axis in range(3):
            for k in range(4):
                impulse[i, axis] += answer[i, axis, k] * wanted[i, k]
    substitute(factors, pivots, impulse.reshape(-1))
    move = np.zeros(points.shape)
    move[:, :3] = impulse
    move[:, 3:6] = unbalanced(delassus, left.ravel(), move)
    for i in range(len(points)):
        b1, b2, n, u1, u2, _, psi = points[i]
        db1, db2, dn, du1, du2, _, _ = move[i]
        others = friction[i] * psi * dn + u1 * db1 + u2 * db2 + b1 * du1 + b2 * du2
        move[i, 6] = (wanted[i, 1] - others) / (friction[i] * n)
    return move


@compiled("f8(f8, f8, f8, f8, f8, f8)")
def until_boundary(height: float, x: float, y: float, dheight: float, dx: float, dy: float) -> float:
    """The smallest t > 0 with height + t dheight = |(x, y) + t (dx, dy)|; infinity when there is none."""
    square = dheight * dheight - dx * dx - dy * dy
    half = height * dheight - x * dx - y * dy
    inside = max(height * height - x * x - y * y, 0.0)
    least = -height / dheight if dheight < 0.0 else np.inf
    discriminant = half * half - square * inside
    if discriminant >= 0.0:
        sum_of_roots = -(half + math.copysign(math.sqrt(discriminant), half))
        for top, bottom in ((sum_of_roots, square), (inside, sum_of_roots)):
            root = top / bottom if bottom != 0.0 else -1.0
            if root > 0.0:
                least = min(least, root)
    return least


@compiled(f"f8({_MATRIX}, {_MATRIX}, {_VECTOR})")
def room(points: np.ndarray, move: np.ndarray, friction: np.ndarray) -> float:
    """How many times the points may be moved before one of them is on the boundary of its cones."""
    least = np.inf
    for i in range(len(points)):
        b1, b2, n, u1, u2, s, psi = points[i]
        db1, db2, dn, du1, du2, ds, dpsi = move[i]
        edge, dedge = friction[i] * n, friction[i] * dn
        least = min(least, until_boundary(edge, b1, b2, dedge, db1, db2))
        least = min(least, until_boundary(psi, u1, u2, dpsi, du1, du2))
        if ds < 0.0:
            least = min(least, -s / ds)
    return least


@compiled(f"Tuple(({_VECTOR}, f8, i8))({_MATRIX}, {_VECTOR}, {_VECTOR}, f8)")
def cone_impulses(
    delassus: np.ndarray, drift: np.ndarray, friction: np.ndarray, precision: float
) -> tuple[np.ndarray, float, int]:
    """The impulses of n points that obey Signorini's and Coulomb's laws, if they are found.

    Inside, a point is a row (b, n, u, s, psi) of 7 numbers.

    Args:
        delassus: W (3 n, 3 n).
        drift: g, velocities without contact (3 n,), m/s.
        friction: mu (n,).
        precision: how far from the laws above the answer may be, m/s and N s m/s.

    Returns:
        lambda (3 n,), N s, how far it is from the laws, and after how many iterations: farther than the precision,
        or NaN, when there is no answer.
    """
    points, violation = beginning(delassus, drift), np.inf
    for iteration in range(_MAX_ITERATIONS):
        left, product = unbalanced(delassus, drift, points), products(points, friction)
        violation = max(np.abs(left).max(), np.abs(product).max())
        if violation <= precision and product[:, 0].max() <= _HOVERING * precision:
            for i in range(len(points)):  # what is felt by no velocity is no touch
                if delassus[3 * i + 2, 3 * i + 2] * points[i, 2] <= precision:
                    points[i, :3] = 0.0
            return points[:, :3].copy().ravel(), violation, iteration
        answer, stiffness = eliminated(points, friction)
        factors = stiffened(delassus, stiffness)
        pivots = eliminate(factors)
        move = newton(delassus, factors, pivots, left, answer, points, friction, -product)
        way = min(1.0, room(points, move, friction))
        mean = product[:, :2].mean()
        kappa = mean * (products(points + way * move, friction)[:, :2].mean() / mean) ** 3
        wanted = -product
        wanted[:, :2] += max(kappa, _LEAST_KAPPA * precision)
        if way > _SHORT:
            wanted -= products(move, friction)
        move = newton(delassus, factors, pivots, left, answer, points, friction, wanted)
        points += min(1.0, _OF_THE_WAY * room(points, move, friction)) * move
    return points[:, :3].copy().ravel(), violation, _MAX_ITERATIONS
