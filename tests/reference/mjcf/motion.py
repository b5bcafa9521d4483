#!/usr/bin/env python3
"""Motion of an MJCF by MuJoCo: `motion.py robot.xml [actuator=control ...] > robot.csv`, with PyPI's `mujoco` 4.0.

Integrator implicitfast at 1e-5 s and at 2e-5 s, of which the error of first order is extrapolated away; contacts and limits off, 1 s from rest in the file's configuration, rows 0.05 s apart: t, then
hinges' and slides' positions less those of the file's configuration, places of free bodies, and for balls roll, pitch and
yaw of their bodies; SI units, angles in rad. Controls are formulas of t.
"""

import math
import sys

import mujoco

STEPS, DURATION, ROWS = (1e-5, 2e-5), 1.0, 20

model = mujoco.MjModel.from_xml_path(sys.argv[1])
model.opt.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT
model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_LIMIT
controls = {}
for argument in sys.argv[2:]:
    if "=" in argument:
        name, formula = argument.split("=", 1)
        controls[model.actuator(name).id] = compile(formula, name, "eval")


def rpy(matrix):
    r = matrix.reshape(3, 3)
    return [math.atan2(r[2, 1], r[2, 2]), math.asin(max(-1.0, min(1.0, -r[2, 0]))), math.atan2(r[1, 0], r[0, 0])]


def row(data):
    mujoco.mj_kinematics(model, data)
    values = [data.time]
    for joint in range(model.njnt):
        place, body = model.jnt_qposadr[joint], model.jnt_bodyid[joint]
        kind = mujoco.mjtJoint(int(model.jnt_type[joint]))
        if kind in (mujoco.mjtJoint.mjJNT_HINGE, mujoco.mjtJoint.mjJNT_SLIDE):
            values.append(data.qpos[place] - model.qpos0[place])
        elif kind == mujoco.mjtJoint.mjJNT_FREE:
            values.extend(data.xpos[body])
        else:
            values.extend(rpy(data.xmat[body]))
    return values


names = ["t"]
for joint in range(model.njnt):
    kind, name = mujoco.mjtJoint(int(model.jnt_type[joint])), model.joint(joint).name or f"joint_{joint}"
    body = model.body(model.jnt_bodyid[joint]).name
    if kind == mujoco.mjtJoint.mjJNT_FREE:
        names.extend(f"{body}_{axis}" for axis in "xyz")
    elif kind == mujoco.mjtJoint.mjJNT_BALL:
        names.extend(f"{body}_{angle}" for angle in ("roll", "pitch", "yaw"))
    else:
        names.append(name)
print(",".join(names))


def motion(step):
    model.opt.timestep = step
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    every = round(DURATION / step / ROWS)
    rows = []
    for count in range(round(DURATION / step) + 1):
        if count % every == 0:
            rows.append(row(data))
        for actuator, formula in controls.items():
            data.ctrl[actuator] = eval(formula, {"t": data.time, "sin": math.sin, "cos": math.cos})
        mujoco.mj_step(model, data)
    return rows


for fine, coarse in zip(*(motion(step) for step in STEPS)):
    print(",".join(f"{2 * x - y:.10g}" for x, y in zip(fine, coarse)))
