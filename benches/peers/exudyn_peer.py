"""Exudyn's times and errors for the slider crank and the four-bar chain, as JSON.

Generalised alpha, spectral radius 0.8, modified Newton, h = 1e-3, nothing written, nothing said. The faster of the dense
and the sparse solver counts.
"""

import json
import sys
import time

import exudyn as exu
from exudyn.utilities import (
    LoadCoordinate, LoadForceVector, MarkerBodyPosition, MarkerNodeCoordinate, Mass1D, Node1D, NodePointGround,
    NodeRigidBody2D, ObjectConnectorCoordinateSpringDamper, ObjectGround, RevoluteJoint2D, RigidBody2D,
)

STEP = 1e-3


def bar(mbs, mass, inertia, position, gravity=0.0, velocity=(0, 0, 0)):
    node = mbs.AddNode(NodeRigidBody2D(
        referenceCoordinates=[*position, 0], initialVelocities=list(velocity)))
    body = mbs.AddObject(RigidBody2D(nodeNumber=node, mass=mass, inertia=inertia))
    if gravity:
        center = mbs.AddMarker(MarkerBodyPosition(bodyNumber=body, localPosition=[0, 0, 0]))
        mbs.AddLoad(LoadForceVector(markerNumber=center, loadVector=[0, -mass * gravity, 0]))
    return node, body


def revolute(mbs, first, at_first, second, at_second):
    markers = [mbs.AddMarker(MarkerBodyPosition(bodyNumber=body, localPosition=[*place, 0]))
               for body, place in ((first, at_first), (second, at_second))]
    mbs.AddObject(RevoluteJoint2D(markerNumbers=markers))


def slider_crank():
    l1, l2, m1, m2, m3, c, k, tau = 0.15, 0.56, 0.37, 0.77, 0.45, 1.0, 5.0, -0.5
    mbs = exu.SystemContainer().AddSystem()
    ground = mbs.AddObject(ObjectGround())
    crank_node, crank = bar(mbs, m1, m1 * l1**2 / 12, (l1 / 2, 0))
    _, rod = bar(mbs, m2, m2 * l2**2 / 12, (l1 + l2 / 2, 0))
    node = mbs.AddNode(Node1D(referenceCoordinates=[l1 + l2]))
    slider = mbs.AddObject(Mass1D(nodeNumber=node, mass=m3, referencePosition=[0, 0, 0]))
    revolute(mbs, ground, (0, 0), crank, (-l1 / 2, 0))
    revolute(mbs, crank, (l1 / 2, 0), rod, (-l2 / 2, 0))
    revolute(mbs, rod, (l2 / 2, 0), slider, (0, 0))
    angle = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=crank_node, coordinate=2))
    mbs.AddLoad(LoadCoordinate(markerNumber=angle, load=tau))
    fixed = mbs.AddNode(NodePointGround())
    ends = [mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=n, coordinate=0)) for n in (fixed, node)]
    mbs.AddObject(ObjectConnectorCoordinateSpringDamper(markerNumbers=ends, stiffness=k, damping=c))
    mbs.Assemble()
    # The node's coordinate counts from its reference, where the spring is free.
    return mbs, lambda: [mbs.GetNodeOutput(node, exu.OutputVariableType.Coordinates) + l1 + l2]


def four_bar(loops):
    mbs = exu.SystemContainer().AddSystem()
    ground = mbs.AddObject(ObjectGround())
    # All bars stay parallel: each turns at -1 rad/s at the start, and its centre and the couplers move along.
    bars = [bar(mbs, 1, 1 / 12, (i, 0.5), 9.81, (0.5, 0, -1)) for i in range(loops + 1)]
    links = [bar(mbs, 1, 1 / 12, (i + 0.5, 1), 9.81, (1, 0, 0)) for i in range(loops)]
    for i, (_, body) in enumerate(bars):
        revolute(mbs, ground, (i, 0), body, (0, -0.5))
    for i, (_, link) in enumerate(links):
        revolute(mbs, bars[i][1], (0, 0.5), link, (-0.5, 0))
        revolute(mbs, link, (0.5, 0), bars[i + 1][1], (0, 0.5))
    mbs.Assemble()
    first = bars[0][1]
    position = exu.OutputVariableType.Position
    return mbs, lambda: mbs.GetObjectOutputBody(first, position, [0, 0.5, 0])[:2].tolist()


def settings(duration, sparse, step):
    s = exu.SimulationSettings()
    s.timeIntegration.numberOfSteps = round(duration / step)
    s.timeIntegration.endTime = duration
    s.timeIntegration.verboseMode = 0
    s.timeIntegration.newton.useModifiedNewton = True
    s.timeIntegration.generalizedAlpha.spectralRadius = 0.8
    s.solution.file.write = False
    s.show.computationTime = False
    s.show.statistics = False
    s.linearSolver.solverType = exu.LinearSolverType.EigenSparse if sparse else exu.LinearSolverType.EXUdense
    return s


def best(build, duration, repetitions, solvers=(False, True), step=STEP):
    """Smallest time over repetitions and solvers, and the output at the end."""
    results = []
    for sparse in solvers:
        for _ in range(repetitions):
            mbs, output = build()
            begun = time.perf_counter()
            mbs.SolveDynamic(settings(duration, sparse, step))
            results.append((time.perf_counter() - begun, output()))
    return min(results, key=lambda result: result[0])


def slider_positions(times, step=STEP):
    """x3 at times, each from a run of its own."""
    return [best(slider_crank, t, 1, step=step)[1][0] for t in times]


def slider_of_step(times, step, repetitions):
    """The slider crank with steps of this length."""
    seconds, _ = best(slider_crank, 2.0, repetitions, step=step)
    return {"step": step, "seconds": seconds, "values": slider_positions(times, step)}


def main():
    times = json.loads(sys.argv[1])
    report = {"slider": slider_of_step(times, STEP, 10)}
    report["slider_shorter"] = [slider_of_step(times, STEP / part, 2) for part in (8, 32)]
    # 40 loops take the dense solver five times as long.
    for loops, repetitions, solvers in ((2, 3, (False, True)), (40, 2, (True,))):
        seconds, end = best(lambda: four_bar(loops), 10.0, repetitions, solvers)
        report[f"four_bar_{loops}"] = {"seconds": seconds, "values": end}
    print(json.dumps({"version": exu.config.Version(), **report}))


main()
