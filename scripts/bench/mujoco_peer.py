#!/usr/bin/env python3
"""P1 and P2 with MuJoCo: rigid links in a plane, a hinge with a spring EI/h between neighbours, 2 EI/h at the clamp.

MuJoCo 4 has no cable plugin any more. Tried, and the choice of each:
- wire: a 1D flex with elasticity (what replaces the plugin; its edges kept their length by constraints, a short
  pinned edge was the clamp) and the chain of hinges. Integrator discrete, P1, a = 10: the flex was 0.4 % off with 10
  edges and 1.3 % with 40, at 7 times the cost of a step. So the chain. It does not stretch: P1 at a = 10 stops at
  4e-5 L.
- P1: no static solver. The discrete integrator, implicit in the springs, with steps so long that inertia hardly
  counts; the tip is looked at every 10 steps and at rest when it moves by less than 1e-8 m. The longest steps that
  converge with every number of links.
- P2: Euler, implicitfast, RK4 and discrete. Euler: without damping it is the symplectic one; implicitfast is the same
  here, RK4 costs twice as much for the same error, discrete takes the amplitude away. Steps near the limit of
  stability.
"""

import mujoco
import numpy as np

import peer
from problems import DIAMETER, EI, LENGTH, MASS, released, steps_of, tip_error, tip_force, vibration_error

# give up on coming to rest, steps
MOST = 5000


def chain(n, dt, integrator):
    """Model of n links."""
    h = LENGTH / n
    mass = MASS * h
    about = mass * DIAMETER**2 / 8.0
    across = mass * h * h / 12.0 + 0.5 * about
    inertial = f'<inertial pos="{h / 2} 0 0" mass="{mass}" diaginertia="{about} {across} {across}"/>'
    bodies = "".join(
        f'<body pos="{h if i > 0 else 0.0} 0 0">'
        f'<joint type="hinge" axis="0 0 1" stiffness="{EI / h * (1 if i > 0 else 2)}"/>{inertial}'
        for i in range(n)
    )
    return mujoco.MjModel.from_xml_string(
        f'<mujoco><option timestep="{dt}" integrator="{integrator}" gravity="0 0 0">'
        '<flag contact="disable" constraint="disable"/></option>'
        f'<worldbody>{bodies}<site name="tip" pos="{h} 0 0"/>{"</body>" * n}</worldbody></mujoco>'
    )


def unstable(data):
    """MuJoCo starts anew where it diverges, with a warning."""
    kinds = (mujoco.mjtWarning.mjWARN_BADQPOS, mujoco.mjtWarning.mjWARN_BADQVEL, mujoco.mjtWarning.mjWARN_BADQACC)
    return any(data.warning[kind].number > 0 for kind in kinds)


def p1(setting):
    n, a = setting["n"], setting["a"]
    force = tip_force(a)
    arm = 0.5 * LENGTH / n

    def prepare():
        model = chain(n, setting["dt"], "discrete")
        data = mujoco.MjData(model)
        mujoco.mj_forward(model, data)
        return model, data, model.site("tip").id

    def solve(made):
        model, data, tip = made
        before = np.zeros(3)
        for step in range(1, MOST + 1):
            # MuJoCo takes forces at the centre of the last link: add the moment that moves this one to the tip
            data.xfrc_applied[-1, 1] = force
            data.xfrc_applied[-1, 5] = arm * data.xmat[-1, 0] * force
            mujoco.mj_step(model, data)
            if step % 10 == 0:
                at = data.site_xpos[tip].copy()
                if np.abs(at - before).max() < setting["tol"]:
                    return step, at
                before = at
        raise RuntimeError(f"not at rest after {MOST} steps")

    def judge(made, solved):
        if unstable(made[1]):
            raise RuntimeError("diverged")
        return {"error": tip_error(a, solved[1]), "steps": solved[0]}

    return prepare, solve, judge


def p2(setting):
    n = setting["n"]
    count, dt = steps_of(setting["per_period"])
    setting["dt"] = dt
    every = max(1, count // 2000)

    def prepare():
        model = chain(n, dt, setting["integrator"])
        data = mujoco.MjData(model)
        points = np.array(released(n))
        along = np.diff(points, axis=0)
        data.qpos[:] = np.diff(np.arctan2(along[:, 1], along[:, 0]), prepend=0.0)
        mujoco.mj_forward(model, data)
        return model, data, model.site("tip").id

    def solve(made):
        model, data, tip = made
        times, heights = [], []
        for _ in range(count // every):
            mujoco.mj_step(model, data, every)
            mujoco.mj_kinematics(model, data)
            times.append(data.time)
            heights.append(data.site_xpos[tip, 1])
        return times, heights

    def judge(made, solved):
        if unstable(made[1]):
            raise RuntimeError("diverged")
        return {"error": vibration_error(*solved), "steps": count}

    return prepare, solve, judge


def p1_setting(a, n):
    return {"n": n, "a": a, "dt": {1: 1.0, 5: 4e-3, 10: 2e-3}[a], "tol": 1e-8}


def p2_setting(n):
    return {"n": n, "per_period": 7.5 * n * n, "integrator": "Euler"}


SETTINGS = {
    "P1": [p1_setting(a, n) for a in (1, 5, 10) for n in (10, 20, 40, 80, 160)],
    "P2": [p2_setting(n) for n in (10, 20, 40, 60)],
}
QUICK = {"P1": [p1_setting(10, 10)], "P2": [p2_setting(10)]}

if __name__ == "__main__":
    peer.main("mujoco", {"P1": p1, "P2": p2}, SETTINGS, QUICK)
