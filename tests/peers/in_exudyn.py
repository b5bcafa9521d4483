"""Mechanisms of Exudyn's own mini examples and test models, made again in Exudyn: prints a JSON object of one number a case.

Python with `exudyn`; steps are so short that the numbers have converged to the digits of the table beside it. Names of
cases are those of `exudyn.csv`.
"""

import json
import math
import sys

import numpy as np
import exudyn as exu
import exudyn.itemInterface as item
from exudyn.beams import GenerateStraightLineANCFCable2D
from exudyn.utilities import InertiaCuboid

STEPS = 20000


def solve(mbs, steps=STEPS, end=1.0, radius=1.0, explicit=False):
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.solutionSettings.writeSolutionToFile = False
    settings.timeIntegration.numberOfSteps = steps
    settings.timeIntegration.endTime = end
    settings.timeIntegration.generalizedAlpha.spectralRadius = radius
    settings.timeIntegration.verboseMode = 0
    if explicit:
        mbs.SolveDynamic(settings, solverType=exu.DynamicSolverType.RK67)
    else:
        mbs.SolveDynamic(settings)


class System:
    def __init__(self):
        self.container = exu.SystemContainer()
        self.mbs = self.container.AddSystem()
        self.ground = self.mbs.AddObject(item.ObjectGround(referencePosition=[0, 0, 0]))
        self.node = self.mbs.AddNode(item.NodePointGround(referenceCoordinates=[0, 0, 0]))

    def point(self, mass, at, velocity=(0, 0, 0)):
        node = self.mbs.AddNode(item.NodePoint(referenceCoordinates=list(at), initialVelocities=list(velocity)))
        return node, self.mbs.AddObject(item.MassPoint(nodeNumber=node, physicsMass=mass))

    def rigid(self, velocity=(0,) * 6):
        node = self.mbs.AddNode(item.NodeRigidBodyRxyz(initialVelocities=list(velocity)))
        body = self.mbs.AddObject(item.RigidBody(physicsMass=1, physicsInertia=[1, 1, 1, 0, 0, 0], nodeNumber=node))
        marker = self.mbs.AddMarker(item.MarkerNodeRigid(nodeNumber=node))
        ground = self.mbs.AddMarker(item.MarkerBodyRigid(bodyNumber=self.ground, localPosition=[0, 0, 0]))
        return node, marker, ground

    def output(self, node, variable):
        return np.atleast_1d(self.mbs.GetNodeOutput(node, variable))


POSITION = exu.OutputVariableType.Position
DISPLACEMENT = exu.OutputVariableType.Displacement
ROTATION = exu.OutputVariableType.Rotation
COORDINATES = exu.OutputVariableType.Coordinates


def mass_point():
    s = System()
    node = s.mbs.AddNode(item.NodePoint(referenceCoordinates=[1, 1, 0], initialCoordinates=[0.5, 0, 0], initialVelocities=[0.5, 0, 0]))
    s.mbs.AddObject(item.MassPoint(nodeNumber=node, physicsMass=1))
    solve(s.mbs, 100)
    return s.output(node, POSITION)[0]


def mass_point_2d():
    s = System()
    node = s.mbs.AddNode(item.NodePoint2D(referenceCoordinates=[1, 1], initialCoordinates=[0.5, 0], initialVelocities=[0.5, 0]))
    s.mbs.AddObject(item.MassPoint2D(nodeNumber=node, physicsMass=1))
    solve(s.mbs, 100)
    return s.output(node, POSITION)[0]


def of_one_coordinate(rotates):
    s = System()
    node = s.mbs.AddNode(item.Node1D(referenceCoordinates=[1], initialCoordinates=[0.5], initialVelocities=[0.5]))
    if rotates:
        s.mbs.AddObject(item.Rotor1D(nodeNumber=node, physicsInertia=1))
    else:
        s.mbs.AddObject(item.Mass1D(nodeNumber=node, physicsMass=1))
    solve(s.mbs, 100)
    return s.output(node, COORDINATES)[0] + 1


def rigid_body_2d():
    s = System()
    node = s.mbs.AddNode(
        item.NodeRigidBody2D(
            referenceCoordinates=[1, 1, 0.25 * math.pi], initialCoordinates=[0.5, 0, 0], initialVelocities=[0.5, 0, 0.75 * math.pi]
        )
    )
    s.mbs.AddObject(item.RigidBody2D(nodeNumber=node, physicsMass=1, physicsInertia=2))
    solve(s.mbs, 100)
    return s.output(node, POSITION)[0] + s.output(node, ROTATION)[-1]


def mass_proportional_load():
    s = System()
    node, body = s.point(2, [1, 0, 0])
    marker = s.mbs.AddMarker(item.MarkerBodyMass(bodyNumber=body))
    s.mbs.AddLoad(item.LoadMassProportional(markerNumber=marker, loadVector=[0, 0, -9.81]))
    solve(s.mbs)
    return s.output(node, POSITION)[2]


def spring_damper():
    s = System()
    node, body = s.point(1, [1.05, 0, 0])
    markers = [s.mbs.AddMarker(item.MarkerBodyPosition(bodyNumber=own, localPosition=[0, 0, 0])) for own in (s.ground, body)]
    s.mbs.AddObject(item.ObjectConnectorSpringDamper(markerNumbers=markers, referenceLength=1, stiffness=100, damping=1))
    solve(s.mbs)
    return s.output(node, POSITION)[0]


def cartesian_spring_damper():
    s = System()
    node, _ = s.point(5, [1, 1, 0])
    marker = s.mbs.AddMarker(item.MarkerNodePosition(nodeNumber=node))
    ground = s.mbs.AddMarker(item.MarkerBodyPosition(bodyNumber=s.ground, localPosition=[1, 1, 0]))
    s.mbs.AddObject(item.CartesianSpringDamper(markerNumbers=[ground, marker], stiffness=[5000] * 3, damping=[0, 250, 0]))
    s.mbs.AddLoad(item.Force(markerNumber=marker, loadVector=[0, -5, 0]))
    solve(s.mbs, 2000)
    mid = s.output(node, DISPLACEMENT)[1]
    return mid


def rigid_body_spring_damper():
    s = System()
    node, marker, ground = s.rigid([0, 1e3, 0, 0, 0, 0])
    s.mbs.AddObject(
        item.RigidBodySpringDamper(
            markerNumbers=[ground, marker], stiffness=np.diag([500, 500, 500, 0, 0, 0]), damping=np.diag([0, 5, 0, 0, 0, 0])
        )
    )
    solve(s.mbs, 200000)
    return s.output(node, DISPLACEMENT)[1]


def torsional_spring_damper():
    s = System()
    node, marker, ground = s.rigid()
    s.mbs.AddObject(item.RevoluteJointZ(markerNumbers=[ground, marker]))
    s.mbs.AddObject(item.TorsionalSpringDamper(markerNumbers=[ground, marker], stiffness=2e3, damping=20))
    s.mbs.AddLoad(item.Torque(markerNumber=marker, loadVector=[0, 0, 1]))
    solve(s.mbs)
    return s.output(node, ROTATION)[2]


def linear_spring_damper():
    s = System()
    node, marker, ground = s.rigid()
    s.mbs.AddObject(item.PrismaticJointX(markerNumbers=[ground, marker]))
    s.mbs.AddObject(item.LinearSpringDamper(markerNumbers=[ground, marker], stiffness=2e3, damping=20))
    s.mbs.AddLoad(item.Force(markerNumber=marker, loadVector=[1, 0, 0]))
    solve(s.mbs)
    return s.output(node, DISPLACEMENT)[0]


def revolute_joint_z():
    s = System()
    node, marker, ground = s.rigid()
    s.mbs.AddObject(item.RevoluteJointZ(markerNumbers=[ground, marker]))
    s.mbs.AddLoad(item.Torque(markerNumber=marker, loadVector=[0, 0, 1]))
    solve(s.mbs)
    return s.output(node, ROTATION)[2]


def along_coordinate(s):
    node, _ = s.point(5, [2, 0, 0])
    ground = s.mbs.AddMarker(item.MarkerNodeCoordinate(nodeNumber=s.node, coordinate=0))
    return node, ground, s.mbs.AddMarker(item.MarkerNodeCoordinate(nodeNumber=node, coordinate=0))


def cubic_spring():
    s = System()
    node, ground, marker = along_coordinate(s)

    def force(mbs, t, number, u, v, k, d, offset):
        return 0.1 * k * u + k * u**3 + v * d

    spring = item.CoordinateSpringDamper(markerNumbers=[ground, marker], stiffness=5000, damping=80, springForceUserFunction=force)
    s.mbs.AddObject(spring)
    s.mbs.AddLoad(item.LoadCoordinate(markerNumber=marker, load=1))
    solve(s.mbs, 4000)
    return s.output(node, DISPLACEMENT)[0]


def moved_coordinate():
    s = System()
    node, ground, marker = along_coordinate(s)

    def offset(mbs, t, number, own):
        return 0.5 * (1 - math.cos(0.5 * math.pi * t)) * own

    constraint = item.CoordinateConstraint(markerNumbers=[ground, marker], offset=0.1, offsetUserFunction=offset)
    s.mbs.AddObject(constraint)
    solve(s.mbs, 1000)
    return s.output(node, DISPLACEMENT)[0]


def distance():
    s = System()
    node = s.mbs.AddNode(item.NodePoint2D(referenceCoordinates=[1, 0]))
    s.mbs.AddObject(item.MassPoint2D(physicsMass=50, nodeNumber=node))
    marker = s.mbs.AddMarker(item.MarkerNodePosition(nodeNumber=node))
    ground = s.mbs.AddMarker(item.MarkerBodyPosition(bodyNumber=s.ground, localPosition=[0, 0, 0]))
    s.mbs.AddObject(item.DistanceConstraint(markerNumbers=[ground, marker], distance=1))
    s.mbs.AddLoad(item.Force(markerNumber=marker, loadVector=[0, -50 * 9.81, 0]))
    solve(s.mbs, 100000, radius=0.9)
    return s.output(node, POSITION)[0]


def generic_ode2():
    s = System()
    nodes = [s.mbs.AddNode(item.NodePoint(referenceCoordinates=[x, 0, 0])) for x in (0, 1)]
    one, none = np.eye(3), np.zeros((3, 3))
    chain = np.block([[2 * one, -one], [-one, one]])
    s.mbs.AddObject(
        item.ObjectGenericODE2(
            nodeNumbers=nodes,
            massMatrix=np.block([[0.5 * one, none], [none, 0.5 * one]]),
            stiffnessMatrix=5000 * chain,
            dampingMatrix=50 * chain,
        )
    )
    marker = s.mbs.AddMarker(item.MarkerNodePosition(nodeNumber=nodes[1]))
    s.mbs.AddLoad(item.Force(markerNumber=marker, loadVector=[10, 0, 0]))
    solve(s.mbs)
    return s.output(nodes[1], POSITION)[0]


def generic_ode1():
    s = System()
    node = s.mbs.AddNode(item.NodeGenericODE1(referenceCoordinates=[0, 0], initialCoordinates=[1, 0], numberOfODE1Coordinates=2))
    s.mbs.AddObject(item.ObjectGenericODE1(nodeNumbers=[node], systemMatrix=np.array([[0, 1], [-100, 0]]), rhsVector=np.array([0, 1])))
    solve(s.mbs, 1000, explicit=True)
    return s.output(node, COORDINATES)[0]


def orbit():
    s = System()
    star, satellite, radius = 1e25, 1e3, 1e5
    speed = math.sqrt(6.6743e-11 * star / radius)
    first, _ = s.point(star, [0, 0, 0])
    second, _ = s.point(satellite, [radius, 0, 0], [0, speed, 0])
    markers = [s.mbs.AddMarker(item.MarkerNodePosition(nodeNumber=own)) for own in (first, second)]
    s.mbs.AddObject(item.ObjectConnectorGravity(markerNumbers=markers, mass0=star, mass1=satellite))
    solve(s.mbs, 1000, radius * 0.5 * math.pi / speed, explicit=True)
    return s.output(second, POSITION)[1]


def kinematic_tree():
    s = System()
    inertia = InertiaCuboid(1000, [1, 0.1, 0.1])
    node = s.mbs.AddNode(
        item.NodeGenericODE2(referenceCoordinates=[0.0], initialCoordinates=[0.0], initialCoordinates_t=[0.0], numberOfODE2Coordinates=1)
    )
    s.mbs.AddObject(
        item.ObjectKinematicTree(
            nodeNumber=node,
            jointTypes=[exu.JointType.RevoluteZ],
            linkParents=[-1],
            jointTransformations=exu.Matrix3DList([np.eye(3)]),
            jointOffsets=exu.Vector3DList([[0, 0, 0]]),
            linkInertiasCOM=exu.Matrix3DList([inertia.InertiaCOM()]),
            linkCOMs=exu.Vector3DList([np.array([0.5, 0.0, 0.0])]),
            linkMasses=[inertia.mass],
            baseOffset=[0.5, 0.0, 0.0],
            gravity=[0.0, -9.81, 0.0],
        )
    )
    solve(s.mbs, 1000, explicit=True)
    return s.output(node, COORDINATES)[0]


def cable():
    s = System()
    template = item.Cable2D(physicsMassPerLength=78.0, physicsBendingStiffness=833.3333333333333, physicsAxialStiffness=1e6)
    nodes = GenerateStraightLineANCFCable2D(
        mbs=s.mbs,
        positionOfNode0=[0, 0, 0],
        positionOfNode1=[2, 0, 0],
        numberOfElements=64,
        cableTemplate=template,
        massProportionalLoad=[0, -9.81, 0],
        fixedConstraintsNode0=[1, 1, 0, 1],
    )[0]
    s.mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.solutionSettings.writeSolutionToFile = False
    s.mbs.SolveStatic(settings)
    return s.output(nodes[-1], DISPLACEMENT)[0]


CASES = {
    "mass_point": mass_point,
    "mass_point_2d": mass_point_2d,
    "mass_1d": lambda: of_one_coordinate(False),
    "rotor_1d": lambda: of_one_coordinate(True),
    "rigid_body_2d": rigid_body_2d,
    "mass_proportional_load": mass_proportional_load,
    "spring_damper": spring_damper,
    "cartesian_spring_damper": cartesian_spring_damper,
    "rigid_body_spring_damper": rigid_body_spring_damper,
    "torsional_spring_damper": torsional_spring_damper,
    "linear_spring_damper": linear_spring_damper,
    "revolute_joint_z": revolute_joint_z,
    "cubic_spring": cubic_spring,
    "moved_coordinate": moved_coordinate,
    "distance": distance,
    "generic_ode2": generic_ode2,
    "generic_ode1": generic_ode1,
    "orbit": orbit,
    "kinematic_tree": kinematic_tree,
    "cable": cable,
}

if __name__ == "__main__":
    chosen = sys.argv[1:] or list(CASES)
    print(json.dumps({name: float(CASES[name]()) for name in chosen}, indent=1))
