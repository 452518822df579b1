"""Wrenches keep their meaning under change of point, axes, block order and up direction."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest

from momentum_lab.momentum.wrench import (
    Z_UP_FROM_Y_UP,
    shift_wrench,
    skew,
    sum_wrenches,
    swap_linear_angular,
    swap_operator_blocks,
    wrench_in_frame_axes,
    wrench_in_world_axes,
    wrench_shift_map,
    y_up_from_z_up,
    z_up_from_y_up,
)
from tests.conftest import assert_close, random_rotation

P = np.block([[np.zeros((3, 3)), np.eye(3)], [np.eye(3), np.zeros((3, 3))]])


def test_skew_is_the_cross_product(rng):
    a, b = rng.normal(size=(2, 3))
    assert_close(skew(a) @ b, np.cross(a, b), 1e-15)


def test_shift_agrees_with_pinocchio(rng):
    wrench, a, b = rng.normal(size=6), *rng.normal(size=(2, 3))
    expected = pin.SE3(np.eye(3), a - b).act(pin.Force(wrench)).vector
    assert_close(shift_wrench(wrench, a, b), expected, 1e-14)


def test_shift_map_is_the_shift(rng):
    wrench, a, b = rng.normal(size=6), *rng.normal(size=(2, 3))
    assert_close(wrench_shift_map(a, b) @ wrench, shift_wrench(wrench, a, b), 1e-14)


def test_shift_there_and_back_changes_nothing(rng):
    wrench, a, b = rng.normal(size=6), *rng.normal(size=(2, 3))
    assert_close(shift_wrench(shift_wrench(wrench, a, b), b, a), wrench, 1e-14)


def test_shift_and_axes_together_are_a_change_of_frame(rng):
    frame = pin.SE3(random_rotation(rng), rng.normal(size=3))
    about_origin = rng.normal(size=6)
    about_frame = shift_wrench(about_origin, np.zeros(3), frame.translation)
    in_frame = wrench_in_frame_axes(about_frame, frame.rotation)
    assert_close(in_frame, frame.actInv(pin.Force(about_origin)).vector, 1e-13)
    assert_close(wrench_in_world_axes(in_frame, frame.rotation), about_frame, 1e-13)


def test_sum_of_wrenches_does_the_same_work_as_its_parts(rng):
    wrenches, points, about = rng.normal(size=(5, 6)), rng.normal(size=(5, 3)), rng.normal(size=3)
    velocity, spin = rng.normal(size=(2, 3))
    work_of_parts = sum(
        w[:3] @ (velocity + np.cross(spin, p - about)) + w[3:] @ spin
        for w, p in zip(wrenches, points, strict=True)
    )
    total = sum_wrenches(wrenches, points, about)
    assert total @ np.concatenate((velocity, spin)) == pytest.approx(work_of_parts, abs=1e-13)


def test_sum_of_no_wrenches_is_zero():
    assert_close(sum_wrenches(np.zeros((0, 6)), np.zeros((0, 3)), np.ones(3)), np.zeros(6), 0.0)


def test_sum_rejects_a_wrench_without_a_point():
    with pytest.raises(ValueError, match="needs the point"):
        sum_wrenches(np.zeros((2, 6)), np.zeros((1, 3)), np.zeros(3))


def test_swap_moves_rows_and_leaves_columns(rng):
    vector, rows, operator = rng.normal(size=6), rng.normal(size=(6, 9)), rng.normal(size=(6, 6))
    assert_close(swap_linear_angular(vector), P @ vector, 0.0)
    assert_close(swap_linear_angular(rows), P @ rows, 0.0)
    assert_close(swap_operator_blocks(operator), P @ operator @ P, 0.0)


def test_swap_is_its_own_inverse(rng):
    vector, operator = rng.normal(size=6), rng.normal(size=(6, 6))
    assert_close(swap_linear_angular(swap_linear_angular(vector)), vector, 0.0)
    assert_close(swap_operator_blocks(swap_operator_blocks(operator)), operator, 0.0)


def test_swapped_operator_maps_swapped_vectors(rng):
    vector, operator = rng.normal(size=6), rng.normal(size=(6, 6))
    chapter = swap_operator_blocks(operator) @ swap_linear_angular(vector)
    assert_close(chapter, swap_linear_angular(operator @ vector), 1e-14)


def test_up_stays_up_and_forward_stays_forward():
    up_in_y_up, forward = np.array([0.0, 1.0, 0.0]), np.array([1.0, 0.0, 0.0])
    assert_close(z_up_from_y_up(up_in_y_up), [0.0, 0.0, 1.0], 0.0)
    assert_close(z_up_from_y_up(forward), forward, 0.0)


def test_change_of_up_keeps_cross_products_and_relabelling_turns_them_around(rng):
    a, b = rng.normal(size=(2, 3))
    rotated = np.cross(z_up_from_y_up(a), z_up_from_y_up(b))
    assert_close(rotated, z_up_from_y_up(np.cross(a, b)), 1e-14)
    relabelled = np.cross(a[[0, 2, 1]], b[[0, 2, 1]])
    assert_close(relabelled, -np.cross(a, b)[[0, 2, 1]], 1e-14)


def test_change_of_up_works_on_rows_and_back(rng):
    points = rng.normal(size=(4, 3))
    assert_close(y_up_from_z_up(z_up_from_y_up(points)), points, 0.0)
    assert_close(z_up_from_y_up(points)[2], Z_UP_FROM_Y_UP @ points[2], 0.0)


def test_the_rotation_cannot_be_overwritten():
    with pytest.raises(ValueError, match="read-only"):
        Z_UP_FROM_Y_UP[0, 0] = 2.0
