#!/usr/bin/env python3
"""Time a sample against error on two robots: mbint, MuJoCo's integrators and Pinocchio's ABA under Dormand-Prince 8(5,3).

    benches/peers/robots.py MBINT [FOLDER]

MBINT is the program to time. Needs mujoco, pin, numpy and scipy. Writes robots.json and robots.svg (curves of time against error) into FOLDER
(`target/robots` where absent), and prints the table at equal error.

The robots are an arm of seven joints and a floating body on four legs of three joints: the same URDF for all, the same start, the same damping of
the joints, no contacts and no limits, one second. The error is the largest difference of a joint's angle at the end from a reference, rad: Pinocchio's
accelerations under DOP853 at 1e-12. One core: mbint's time is that of a sample of a batch (`at_error.BATCH`), MuJoCo's that of a run, Pinocchio's the
evaluations of its method times one call of ABA in C++ (through its Python bindings where that cannot be compiled).
"""

import json
import math
import os
import subprocess
import sys
import time
from pathlib import Path

import mujoco
import numpy as np
import pinocchio
from scipy.integrate import DOP853, solve_ivp

from at_error import WANTED, at_error, time_of_sample

DURATION = 1.0


def link(name, mass, center, size):
    a, b, c = size
    xx, yy, zz = (mass * (p * p + q * q) / 12 for p, q in ((b, c), (a, c), (a, b)))
    return f"""  <link name="{name}"><inertial><origin xyz="{center[0]} {center[1]} {center[2]}"/><mass value="{mass}"/>
    <inertia ixx="{xx:.8f}" iyy="{yy:.8f}" izz="{zz:.8f}" ixy="0" ixz="0" iyz="0"/></inertial></link>\n"""


def joint(name, parent, child, origin, rpy, axis, damping):
    return f"""  <joint name="{name}" type="continuous"><parent link="{parent}"/><child link="{child}"/>
    <origin xyz="{origin[0]} {origin[1]} {origin[2]}" rpy="{rpy[0]:.15g} {rpy[1]:.15g} {rpy[2]:.15g}"/><axis xyz="{axis}"/><dynamics damping="{damping}"/></joint>\n"""


def arm():
    """Seven revolute joints with axes at right angles, of a manipulator's proportions."""
    quarter = math.pi / 2
    places = [((0, 0, 0.33), (0, 0, 0)), ((0, 0, 0), (-quarter, 0, 0)), ((0, -0.32, 0), (quarter, 0, 0)),
              ((0.08, 0, 0), (quarter, 0, 0)), ((-0.08, 0.38, 0), (-quarter, 0, 0)), ((0, 0, 0), (quarter, 0, 0)),
              ((0.09, 0, 0), (quarter, 0, 0))]
    bodies = [(4.0, (0, -0.03, -0.1), (0.1, 0.1, 0.3)), (3.5, (0, -0.1, 0.03), (0.1, 0.3, 0.1)), (3.0, (0.04, 0.03, -0.06), (0.1, 0.1, 0.25)),
              (2.7, (-0.04, 0.08, 0.03), (0.1, 0.25, 0.1)), (2.2, (0, 0.04, -0.12), (0.1, 0.1, 0.3)), (1.4, (0.05, 0, 0), (0.15, 0.1, 0.1)),
              (0.8, (0.01, 0.01, 0.08), (0.08, 0.08, 0.1))]
    text = link("base", 3, (0, 0, 0), (0.2, 0.2, 0.2))
    for i, ((origin, rpy), (mass, center, size)) in enumerate(zip(places, bodies)):
        text += link(f"l{i + 1}", mass, center, size)
        text += joint(f"j{i + 1}", f"l{i}" if i else "base", f"l{i + 1}", origin, rpy, "0 0 1", 0.3)
    start = [0.3, 0.6, -0.4, 1.2, 0.5, 0.8, -0.2]
    return f'<robot name="arm">\n{text}</robot>\n', [f"j{i + 1}" for i in range(7)], start, [0.0] * 7, False


def quadruped():
    """A floating body on four legs that swing as it falls: without rates at the start nothing would turn."""
    text = '  <link name="world"/>\n' + link("trunk", 6, (0, 0, 0), (0.4, 0.2, 0.1))
    text += '  <joint name="float" type="floating"><parent link="world"/><child link="trunk"/></joint>\n'
    names, start, rates = [], [], []
    for place, (x, y) in enumerate(((0.2, 0.1), (0.2, -0.1), (-0.2, 0.1), (-0.2, -0.1))):
        side = math.copysign(1, y)
        parts = [("hip", "trunk", (x, y, 0), "1 0 0", 0.6, (0, 0.02 * side, 0), (0.08, 0.08, 0.08)),
                 ("thigh", "hip", (0, 0.05 * side, 0), "0 1 0", 0.8, (0, 0, -0.07), (0.05, 0.05, 0.16)),
                 ("shank", "thigh", (0, 0, -0.16), "0 1 0", 0.25, (0, 0, -0.08), (0.03, 0.03, 0.16))]
        for number, (part, parent, origin, axis, mass, center, size) in enumerate(parts):
            parent = parent if parent == "trunk" else f"{parent}{place}"
            text += link(f"{part}{place}", mass, center, size)
            text += joint(f"{part}_joint{place}", parent, f"{part}{place}", origin, (0, 0, 0), axis, 0.05)
            names.append(f"{part}_joint{place}")
            start.append([0.3 * side, 0.8, -1.4][number] * (1 + 0.1 * place))
            rates.append([1.0, 4.0 * side, -6.0][number] * (1 - 0.1 * place))
    return f'<robot name="quadruped">\n{text}</robot>\n', names, start, rates, True


class Pinocchio:
    def __init__(self, path, names, start, start_rates):
        self.model = pinocchio.buildModelFromUrdf(str(path))
        self.data = self.model.createData()
        self.q0 = pinocchio.neutral(self.model)
        self.joints = [self.model.joints[self.model.getJointId(name)] for name in names]
        for joint_model, angle in zip(self.joints, start):
            # A continuous joint is a point of the unit circle.
            if joint_model.nq == 2:
                self.q0[joint_model.idx_q:joint_model.idx_q + 2] = math.cos(angle), math.sin(angle)
            else:
                self.q0[joint_model.idx_q] = angle
        self.start = np.array(start)
        self.damping = np.zeros(self.model.nv)
        self.places = [joint_model.idx_v for joint_model in self.joints]
        self.v0 = np.zeros(self.model.nv)
        self.v0[self.places] = start_rates

    def run(self, tolerance, damping):
        """Integrates the tangent vector from the start, which is no larger than a turn."""
        self.damping[self.places] = damping
        nv, count = self.model.nv, 0

        def rates(_, state):
            nonlocal count
            count += 1
            s, v = state[:nv], state[nv:]
            q = pinocchio.integrate(self.model, self.q0, s)
            a = pinocchio.aba(self.model, self.data, q, v, -self.damping * v)
            # The derivative of the tangent vector: v through the inverse of the exponential's differential.
            jacobian = pinocchio.dIntegrate(self.model, self.q0, s)[1] if nv != len(self.joints) else None
            return np.concatenate([v if jacobian is None else np.linalg.solve(jacobian, v), a])

        end = solve_ivp(rates, (0, DURATION), np.concatenate([np.zeros(nv), self.v0]), method=DOP853, rtol=tolerance, atol=tolerance)
        return self.start + end.y[self.places, -1], count

    def call(self):
        """Time of one call of ABA through the Python bindings, s."""
        q, v = self.q0.copy(), np.zeros(self.model.nv)
        best = math.inf
        for _ in range(20):
            begun = time.perf_counter()
            for _ in range(1000):
                pinocchio.aba(self.model, self.data, q, v, v)
            best = min(best, time.perf_counter() - begun)
        return best / 1000


def call_in_cpp(path, folder):
    """Time of one call of ABA in C++ (`aba.cpp`), s; None where it cannot be compiled: it needs g++ and the headers of Eigen and urdfdom."""
    prefix = Path(pinocchio.__file__).resolve().parents[4]
    program = folder / "aba"
    if not program.exists():
        include, lib = prefix / "include", prefix / "lib"
        built = subprocess.run(
            ["g++", "-O3", "-DNDEBUG", "-std=c++17", "-w", "-DBOOST_MPL_LIMIT_LIST_SIZE=30", "-DBOOST_MPL_CFG_NO_PREPROCESSED_HEADERS",
             f"-I{include}", "-I/usr/include/eigen3", Path(__file__).with_name("aba.cpp"), "-o", program, f"-L{lib}", "-lpinocchio_parsers",
             "-lpinocchio_default", f"-Wl,-rpath,{lib}"], capture_output=True)
        if built.returncode != 0:
            print("Pinocchio in C++ cannot be compiled here: its calls are timed through Python", file=sys.stderr)
            return None
    return float(subprocess.run([program, path], capture_output=True, text=True, check=True).stdout)


def run_mujoco(path, names, start, rates):
    """Time and angles at the end by integrator and step."""
    text = path.read_text().replace("<robot ", "<robot ", 1).replace(
        "</robot>", '<mujoco><compiler fusestatic="false" discardvisual="true"/></mujoco></robot>')
    model = mujoco.MjModel.from_xml_string(text)
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT | mujoco.mjtDisableBit.mjDSBL_LIMIT
    places = [model.joint(name).qposadr[0] for name in names]
    speeds = [model.joint(name).dofadr[0] for name in names]
    data = mujoco.MjData(model)
    integrators = {"Euler": mujoco.mjtIntegrator.mjINT_EULER, "implicit": mujoco.mjtIntegrator.mjINT_IMPLICIT,
                   "RK4": mujoco.mjtIntegrator.mjINT_RK4}
    for name, integrator in integrators.items():
        model.opt.integrator = integrator
        for steps in (100, 200, 500, 1000, 2000, 5000, *((10000,) if name == "RK4" else (20000,))):
            model.opt.timestep = DURATION / steps
            best = math.inf
            for _ in range(3):
                mujoco.mj_resetData(model, data)
                data.qpos[places], data.qvel[speeds] = start, rates
                begun = time.perf_counter()
                mujoco.mj_step(model, data, nstep=steps)
                best = min(best, time.perf_counter() - begun)
            yield f"MuJoCo {name}", best, np.array(data.qpos[places])


def run_mbint(program, path, names, start, rates, floating):
    """Time a sample, and the nominal angles at the end, by method."""
    initial = ", ".join(f"{name}.angle: {angle!r}, {name}.angular_velocity: {rate!r}" for name, angle, rate in zip(names, start, rates))
    outputs = ", ".join(f"{name}: {name}.angle" for name in names)
    own = "trunk" if floating else "l7"
    settings = [("HHT-I3", f"step: {1 / steps}, scheme: hht") for steps in (200, 500, 1000, 2000)]
    settings += [(f"HHT-I3, {levels} levels", f"step: {1 / steps}, scheme: hht, extrapolation: {levels}")
                 for levels in (3, 4) for steps in (100, 200, 500)]
    settings += [("explicit", f"tolerance: 1e-{digits}, scheme: explicit") for digits in range(3, 12)]
    for name, setting in settings:
        model = (f"urdf: robot.urdf\nparameters: {{ link.{own}.mass: 0.1% }}\n"
                 "effects: { weight: { gravity: { acceleration: [0, 0, -9.81] } } }\n"
                 f"initial: {{ {initial} }}\noutputs: {{ {outputs} }}\n"
                 f"simulation: {{ duration: {DURATION}, output_step: {DURATION}, {setting} }}\nbounds: {{ scan: {{ points: 2 }} }}\n")
        timed = time_of_sample(program, model, f"link.{own}.mass", 6 if floating else 0.8, {"robot.urdf": path.read_text()})
        if timed:
            seconds, samples = timed
            order = [list(samples["output_names"]).index(joint_name) for joint_name in names]
            yield f"mbint {name}", seconds, samples["values"][0, -1, order]


def damping_of(path):
    return float(path.read_text().split('damping="')[1].split('"')[0])


def picture(results):
    """Curves of time against error, one panel a robot."""
    colours = ["#1b6ca8", "#2a9d8f", "#264653", "#6a4c93", "#c1121f", "#e76f51", "#f4a261", "#888888"]
    width, height, parts = 460, 320, []
    for panel, (robot, lines) in enumerate(results.items()):
        left = 60 + panel * (width + 40)
        everything = [point for points in lines.values() for point in points if min(point) > 0]
        lows, highs = ([f(math.log10(point[axis]) for point in everything) for axis in (0, 1)] for f in (min, max))

        def place(point):
            x, y = ((math.log10(point[axis]) - lows[axis]) / (highs[axis] - lows[axis]) for axis in (0, 1))
            return left + x * (width - 60), 40 + (1 - y) * (height - 60)

        parts.append(f'<text x="{left}" y="25" font-weight="bold">{robot}: s a sample against error, rad</text>')
        for axis in (0, 1):
            for power in range(math.ceil(lows[axis]), math.floor(highs[axis]) + 1, 2 if axis == 0 else 1):
                point = [10 ** lows[0], 10 ** lows[1]]
                point[axis] = 10.0 ** power
                x, y = place(point)
                anchor, x, y = ("middle", x, y + 16) if axis == 0 else ("end", x - 6, y + 4)
                parts.append(f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}">1e{power}</text>')
        for number, (name, points) in enumerate(lines.items()):
            colour = colours[number % len(colours)]
            track = " ".join(f"{x:.1f},{y:.1f}" for x, y in map(place, sorted(point for point in points if min(point) > 0)))
            parts.append(f'<polyline points="{track}" fill="none" stroke="{colour}" stroke-width="1.5"/>')
            parts.append(f'<text x="{left}" y="{height + 20 + 14 * number}" fill="{colour}">{name}</text>')
    return (f'<svg xmlns="http://www.w3.org/2000/svg" width="{len(results) * (width + 40) + 60}" height="{height + 150}" font-family="sans-serif" '
            f'font-size="11">\n' + "\n".join(parts) + "\n</svg>\n")


def main():
    program = Path(sys.argv[1]).resolve()
    folder = Path(sys.argv[2] if len(sys.argv) > 2 else "target/robots")
    folder.mkdir(parents=True, exist_ok=True)
    os.environ["OMP_NUM_THREADS"] = "1"
    results = {}
    for text, names, start, rates, floating in (arm(), quadruped()):
        robot = text.split('name="')[1].split('"')[0]
        path = folder / f"{robot}.urdf"
        path.write_text(text)
        peer = Pinocchio(path, names, start, rates)
        exact, _ = peer.run(1e-12, damping_of(path))
        lines = {}

        def note(name, seconds, angles):
            lines.setdefault(name, []).append((float(np.max(np.abs(angles - exact))), seconds))
            print(f"{robot}: {name}: {lines[name][-1][0]:.2e} rad, {1e3 * seconds:.4g} ms", file=sys.stderr)

        call = call_in_cpp(path, folder) or peer.call()
        for digits in range(3, 12):
            angles, count = peer.run(10.0 ** -digits, damping_of(path))
            note("Pinocchio ABA, DOP853", call * count, angles)
        for found in run_mujoco(path, names, start, rates):
            note(*found)
        for found in run_mbint(program, path, names, start, rates, floating):
            note(*found)
        results[robot] = lines
    (folder / "robots.json").write_text(json.dumps(results, indent=1))
    (folder / "robots.svg").write_text(picture(results))
    print("| robot | method |" + "".join(f" {wanted:.0e} rad |" for wanted in WANTED) + "\n| --- | --- |" + " --: |" * len(WANTED))
    for robot, lines in results.items():
        for name, points in lines.items():
            row = [at_error(points, wanted) for wanted in WANTED]
            cells = ["–" if cell is None else f"{1e3 * cell[0]:.3g} ms{' (extrapolated)' if cell[1] else ''}" for cell in row]
            print(f"| {robot} | {name} | " + " | ".join(cells) + " |")


if __name__ == "__main__":
    main()
