#!/usr/bin/env python3
"""Joint positions of a robot that swings freely: `swing.py crane.urdf > crane.csv`.

Recursive Newton-Euler dynamics in minimal coordinates, in the world's frame (Featherstone, Rigid Body Dynamics
Algorithms, 2008, chapters 5 and 6), integrated by the classical Runge-Kutta scheme. Python's standard library is all it
needs. Starts at rest at q_i = 0.3 sin(1 + i) in the order of the file, base fixed, g = 9.81 m/s2 in -z, joint damping as in
the file, no limits, no Coulomb friction. Rows 0.01 s apart over 1 s, angles in rad, displacements in m.
"""

import math
import sys
import xml.etree.ElementTree as xml

STEP = 2e-4


def add(*vectors):
    return [sum(parts) for parts in zip(*vectors)]


def scale(factor, vector):
    return [factor * part for part in vector]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def apply(matrix, vector):
    return [dot(row, vector) for row in matrix]


def times(a, b):
    return [[dot(row, column) for column in zip(*b)] for row in a]


def transposed(matrix):
    return [list(column) for column in zip(*matrix)]


def about(axis, angle):
    """Rodrigues' rotation."""
    (x, y, z), s, c = axis, math.sin(angle), math.cos(angle)
    k = 1 - c
    return [
        [c + k * x * x, k * x * y - s * z, k * x * z + s * y],
        [k * x * y + s * z, c + k * y * y, k * y * z - s * x],
        [k * x * z - s * y, k * y * z + s * x, c + k * z * z],
    ]


def rpy(angles):
    x, y, z = angles
    return times(about([0, 0, 1], z), times(about([0, 1, 0], y), about([1, 0, 0], x)))


def numbers(element, name, default):
    found = None if element is None else element.get(name)
    return default if found is None else [float(part) for part in found.split()]


class Link:
    def __init__(self, robot, joint):
        self.name, self.kind = joint.get("name"), joint.get("type")
        self.parent, self.child = joint.find("parent").get("link"), joint.find("child").get("link")
        origin, axis = joint.find("origin"), numbers(joint.find("axis"), "xyz", [1.0, 0.0, 0.0])
        self.offset, self.turned = numbers(origin, "xyz", [0.0] * 3), rpy(numbers(origin, "rpy", [0.0] * 3))
        self.axis = scale(1 / math.sqrt(dot(axis, axis)), axis)
        self.damping = numbers(joint.find("dynamics"), "damping", [0.0])[0]
        inertial = next(link for link in robot.findall("link") if link.get("name") == self.child).find("inertial")
        self.mass = numbers(inertial.find("mass"), "value", None)[0]
        self.center = numbers(inertial.find("origin"), "xyz", [0.0] * 3)
        xx, yy, zz, xy, xz, yz = (
            numbers(inertial.find("inertia"), name, None)[0] for name in ["ixx", "iyy", "izz", "ixy", "ixz", "iyz"]
        )
        turn = rpy(numbers(inertial.find("origin"), "rpy", [0.0] * 3))
        self.inertia = times(turn, times([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]], transposed(turn)))


def forces(links, moving, q, v, a):
    """Forces and torques along the joints that this motion takes, gravity and damping included."""
    still = [[1.0, 0, 0], [0, 1.0, 0], [0, 0, 1.0]]
    frames = {links[0].parent: (still, [0.0] * 3, [0.0] * 3, [0.0] * 3, [0.0, 0.0, 9.81])}
    passed = []
    for link in links:
        turn, place, spin, spin_rate, acceleration = frames[link.parent]
        arm = apply(turn, link.offset)
        turn = times(turn, link.turned)
        axis = apply(turn, link.axis)
        x, u, w = (0.0, 0.0, 0.0) if link.name not in moving else (
            values[moving.index(link.name)] for values in (q, v, a))
        if link.kind == "prismatic":
            arm = add(arm, scale(x, axis))
        outer = add(acceleration, cross(spin_rate, arm), cross(spin, cross(spin, arm)))
        if link.kind == "prismatic":
            outer = add(outer, scale(2 * u, cross(spin, axis)), scale(w, axis))
        elif link.kind != "fixed":
            turn = times(turn, about(link.axis, x))
            spin_rate = add(spin_rate, scale(w, axis), scale(u, cross(spin, axis)))
            spin = add(spin, scale(u, axis))
        place = add(place, arm)
        frames[link.child] = (turn, place, spin, spin_rate, outer)
        center = apply(turn, link.center)
        inertia = times(turn, times(link.inertia, transposed(turn)))
        force = scale(link.mass, add(outer, cross(spin_rate, center), cross(spin, cross(spin, center))))
        torque = add(apply(inertia, spin_rate), cross(spin, apply(inertia, spin)), cross(center, force))
        passed.append([link, place, axis, force, torque])
    result = [0.0] * len(moving)
    for number in reversed(range(len(links))):
        link, place, axis, force, torque = passed[number]
        if link.name in moving:
            along = dot(axis, force if link.kind == "prismatic" else torque)
            index = moving.index(link.name)
            result[index] = along + link.damping * v[index]
        for other in passed[:number]:
            if other[0].child == link.parent:
                other[3] = add(other[3], force)
                other[4] = add(other[4], torque, cross(add(place, scale(-1, other[1])), force))
    return result


def solve(matrix, right):
    """Gauss's elimination with partial pivoting."""
    n = len(right)
    rows = [list(row) + [value] for row, value in zip(matrix, right)]
    for column in range(n):
        best = max(range(column, n), key=lambda row: abs(rows[row][column]))
        rows[column], rows[best] = rows[best], rows[column]
        for row in range(column + 1, n):
            factor = rows[row][column] / rows[column][column]
            rows[row] = [x - factor * y for x, y in zip(rows[row], rows[column])]
    found = [0.0] * n
    for row in reversed(range(n)):
        found[row] = (rows[row][n] - dot(rows[row][row + 1 : n], found[row + 1 :])) / rows[row][row]
    return found


def main():
    robot = xml.parse(sys.argv[1]).getroot()
    joints = list(robot.findall("joint"))
    links = [Link(robot, joint) for joint in joints]
    moving = [link.name for link in links if link.kind != "fixed"]
    n = len(moving)
    unit = [[float(i == j) for j in range(n)] for i in range(n)]

    def rates(state):
        q, v = state[:n], state[n:]
        rest = forces(links, moving, q, v, [0.0] * n)
        columns = [[x - y for x, y in zip(forces(links, moving, q, v, e), rest)] for e in unit]
        return v + solve(transposed(columns), scale(-1, rest))

    state = [0.3 * math.sin(1 + i) for i in range(n)] + [0.0] * n
    print("t," + ",".join(moving))
    every = round(0.01 / STEP)
    for step in range(100 * every + 1):
        if step % every == 0:
            print(",".join(f"{x:.12g}" for x in [step * STEP] + state[:n]))
        k1 = rates(state)
        k2 = rates(add(state, scale(STEP / 2, k1)))
        k3 = rates(add(state, scale(STEP / 2, k2)))
        k4 = rates(add(state, scale(STEP, k3)))
        state = add(state, scale(STEP / 6, add(k1, scale(2, k2), scale(2, k3), k4)))


main()
