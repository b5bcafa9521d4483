"""Reference values of the cases of Project Chrono's unit tests that state a closed form or minimal equations: prints
`chrono.csv`. Python with numpy. The formulas are those of textbooks; numbers are of the tests named in each row.
"""

import csv
import math
import sys

import numpy as np
G = 9.81
COUPLED = "core/utest_CH_assembly_acceleration_coupled.cpp"
ROUNDING = "accelerations at the start: rounding"


def chain(th, w):
    n = len(th)
    number = lambda i, j: n - max(i, j)
    mass = np.array([[number(i, j) * math.cos(th[i] - th[j]) for j in range(n)] for i in range(n)])
    right = [
        -number(i, i) * G * math.sin(th[i]) - sum(number(i, j) * math.sin(th[i] - th[j]) * w[j] ** 2 for j in range(n))
        for i in range(n)
    ]
    rates = np.linalg.solve(mass, right)
    found, x, y = [], 0.0, 0.0
    for angle, speed, rate in zip(th, w, rates):
        x += rate * math.cos(angle) - speed**2 * math.sin(angle)
        y += rate * math.sin(angle) + speed**2 * math.cos(angle)
        found += [x, y]
    return found


def cart_pole(cart, th, speed=3.0):
    s, c = math.sin(th), math.cos(th)
    x, rate = np.linalg.solve([[cart + 1, c], [c, 1]], [speed**2 * s, -G * s])
    return [x, x + rate * c - speed**2 * s, rate * s + speed**2 * c]


def slider_crank(ratio, slider, th, speed=4.0):
    s, c = math.sin(th), math.cos(th)
    x = c + math.sqrt(ratio**2 - s**2)
    v = -x * s * speed / (x - c)
    j = [2 * x * s, 2 * x - 2 * c]
    gamma = -(2 * v**2 + 4 * v * s * speed + 2 * x * c * speed**2)
    rate, a, _ = np.linalg.solve([[1, 0, j[0]], [0, slider, j[1]], [j[0], j[1], 0]], [-G * c, 0, gamma])
    return [-rate * s - speed**2 * c, rate * c - speed**2 * s, a]


def integrated(rates, start, end, steps=20000):
    """Classical Runge–Kutta: errors of 1e-13."""
    y, h = np.array(start, dtype=float), end / steps
    f = lambda y: np.array(rates(0.0, y))
    for _ in range(steps):
        k1 = f(y)
        k2 = f(y + 0.5 * h * k1)
        k3 = f(y + 0.5 * h * k2)
        k4 = f(y + h * k3)
        y = y + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    return y


def double_pendulum():
    def rates(_, y):
        p, q, v, w = y
        mass = [[2.25, 0.5 * math.cos(q - p)], [0.5 * math.cos(q - p), 1.25]]
        f = [
            -15 * math.cos(p) + 0.5 * w**2 * math.sin(q - p),
            -5 * math.cos(q) - 0.5 * v**2 * math.sin(q - p),
        ]
        return [v, w, *np.linalg.solve(mass, f)]

    p, q, v, w = integrated(rates, [0, 0, 0, 0], 1)
    x, y = math.cos(p) + 0.5 * math.cos(q), math.sin(p) + 0.5 * math.sin(q)
    return [x, y, -math.sin(p) * v - 0.5 * math.sin(q) * w, math.cos(p) * v + 0.5 * math.cos(q) * w]


def slider_pendulum():
    def rates(_, y):
        x, p, v, w = y
        mass = [[2, -0.5 * math.sin(p)], [-0.5 * math.sin(p), 1.25]]
        return [v, w, *np.linalg.solve(mass, [0.5 * math.cos(p) * w**2 - 10 * x, -5 * math.cos(p)])]

    x, p, _, _ = integrated(rates, [0, 0, 0, 0], 5)
    return [x + 0.5 * math.cos(p), 0.5 * math.sin(p)]


def rows():
    chains = [
        ([0.4, -0.7], [1.5, -2.0], "N=2"),
        ([0.3, 1.1, -0.5], [2.0, -1.0, 3.0], "N=3"),
        ([0.2, 0.5, -0.4, 1.0, -1.2], [1.0, -1.5, 2.0, -0.5, 1.0], "N=5"),
        ([0.6, 0.6, 0.6], [2.0, 2.0, 2.0], "N=3 aligned"),
        ([0.4, 0.4 + math.pi, 0.4], [1.0, -1.0, 1.0], "N=3 folded"),
    ]
    for th, w, name in chains:
        given = [f"th{i + 1}={a!r} rad" for i, a in enumerate(th)] + [f"w{i + 1}={a!r} rad/s" for i, a in enumerate(w)]
        outputs = [f"{letter}{i + 1}" for i in range(len(th)) for letter in "xy"]
        yield f"pendulum chain, {name}", f"chain{len(th)}", given, outputs, chain(th, w), 1e-9, COUPLED, ROUNDING
    for cart in (10.0, 1.0, 0.01):
        for th in (0.0, 1.0, 2.5):
            given = [f"M={cart!r} kg", f"th={th!r} rad"]
            yield f"cart-pole, M/m = {cart:g}, θ = {th:g}", "cart_pole", given, ["cart", "x", "y"], cart_pole(cart, th), 1e-9, COUPLED, ROUNDING
    for ratio in (3.0, 1.5):
        for slider in (1.0, 100.0):
            for th in (0.0, 0.3, 1.0, math.pi):
                given = [f"ratio={ratio!r}", f"ms={slider!r} kg", f"th={th!r} rad"]
                name = f"slider-crank, l/r = {ratio:g}, mₛ/m = {slider:g}, θ = {th:.3g}"
                yield name, "slider_crank", given, ["x", "y", "slider"], slider_crank(ratio, slider, th), 1e-9, COUPLED, ROUNDING
    rate = 6 / (10 + 100 * 0.01)
    exact = [0.125 * rate, -0.0125 * rate, 0.5 * rate, rate]
    source = "physics/utest_CH_shafts.cpp: shaft_shaft"
    yield "two shafts and a gear", "shaft_shaft", [], ["first", "second", "speed", "rate"], exact, 1e-9, source, "constant accelerations: rounding"
    exact = [0.0345404, 0.126221]
    source = "physics/utest_CH_shafts.cpp: shaft_body"
    yield "a shaft on a body and a spring", "shaft_body", [], ["angle", "speed"], exact, 1e-3, source, "Chrono's own reference, of first order in a step of 1 ms"
    reason = "in minimal coordinates, Runge–Kutta with 20 000 steps"
    yield "double pendulum at 1 s", "double_pendulum", [], ["x", "y", "vx", "vy"], double_pendulum(), 1e-8, "physics/utest_CH_double_pend.cpp", reason
    yield "slider and pendulum at 5 s", "slider_pendulum", [], ["x", "y"], slider_pendulum(), 1e-8, "physics/utest_CH_slider_pend.cpp", reason
    bending, shear = 64e-3 / (3 * 720.72), 0.4 / 19407142.85714286
    reason = "linear beams of the test: large rotations and the chord's shortening are less"
    for number in range(1, 6):
        load = 2.0 * number
        for kind, exact in (("euler", bending), ("timoshenko", bending + shear)):
            name = f"cantilever of {kind.capitalize()}, {load:g} N"
            yield name, f"beam_{kind}", [f"load={load!r} N"], ["tip"], [-load * exact], 1e-5, "fea/utest_FEA_beams_static.cpp", reason


if __name__ == "__main__":
    writer = csv.writer(sys.stdout, lineterminator="\n")
    writer.writerow(["case", "model", "set", "outputs", "reference", "tolerance", "source", "reason"])
    for case, model, given, outputs, reference, tolerance, source, reason in rows():
        numbers = [f"{value:.13g}" for value in reference]
        writer.writerow([case, model, ";".join(given), ";".join(outputs), ";".join(numbers), f"{tolerance:g}", source, reason])
