#!/usr/bin/env python3
"""P1 and P2 with Exudyn: ANCFCable2D, cubic in its two nodes' places and slopes, extensible, not shearable.

Tried, and the choice of each:
- integration over an element: full, reduced, Lobatto and Gauss (Exudyn's 0, 1, 2). P1 takes 2, ten times closer at the same number
  of elements; P2 takes 1, no further off and without the spurious modes that 2 may have.
- linear solver: dense and sparse. Dense up to 8 elements, sparse beyond.
- P1: load in 1, 2, 3 and 5 steps. The fewest that converge; tolerance 1e-10, since 1e-8 stops 5e-6 L away at a = 1.
- P2: generalised-alpha with spectral radius 1 (the trapezoidal rule) and 0.95 (no better); Newton's method full and modified
  (2 to 3 times faster); tolerances 1e-6 and 1e-8 (no difference). Two elements are within 1 % already.
"""

import exudyn as exu
import exudyn.itemInterface as items
from exudyn import beams

import peer
from problems import (
    EA, EI, LENGTH, MASS, PERIOD, PERIODS, mode, mode_slope, steps_of, tip_error, tip_force, vibration_error,
)

LINEAR = {"dense": exu.LinearSolverType.EXUdense, "sparse": exu.LinearSolverType.EigenSparse}


def cable(n, integration):
    """System with a clamped cable of n elements, and its nodes."""
    container = exu.SystemContainer()
    system = container.AddSystem()
    element = items.ObjectANCFCable2D(
        length=LENGTH / n,
        massPerLength=MASS,
        bendingStiffness=EI,
        axialStiffness=EA,
        useReducedOrderIntegration=integration,
    )
    # the slope along the wire stays free: a clamp holds its direction, not the stretch
    made = beams.GenerateBeamElementsAlongLine(
        system, [0, 0, 0], [LENGTH, 0, 0], n, element, groundConstraintsStart=[True, True, False, True]
    )
    return container, system, made["nodes"]


def settings_of(setting):
    settings = exu.SimulationSettings()
    settings.linearSolver.solverType = LINEAR[setting["linear"]]
    settings.solution.file.write = False
    return settings


def p1(setting):
    n, a = setting["n"], setting["a"]

    def prepare():
        container, system, nodes = cable(n, setting["integration"])
        marker = system.AddMarker(items.MarkerNodePosition(nodeNumber=nodes[-1]))
        system.AddLoad(items.LoadForceVector(markerNumber=marker, loadVector=[0, tip_force(a), 0]))
        system.Assemble()
        settings = settings_of(setting)
        static = settings.staticSolver
        static.numberOfLoadSteps = setting["loads"]
        static.newton.relativeTolerance = setting["tol"]
        static.newton.absoluteTolerance = 1e-12
        static.verboseMode = 0
        return container, system, nodes, settings

    def solve(model):
        _, system, nodes, settings = model
        if not system.SolveStatic(settings):
            raise RuntimeError("Newton's method does not converge")
        return system.GetNodeOutput(nodes[-1], exu.OutputVariableType.Position)

    def judge(model, tip):
        iterations = model[1].sys["staticSolver"].it.newtonStepsCount
        return {"error": tip_error(a, tip), "steps": setting["loads"], "iterations": iterations}

    return prepare, solve, judge


def p2(setting):
    n = setting["n"]
    count, dt = steps_of(setting["per_period"])
    setting["dt"] = dt

    def prepare():
        container, system, nodes = cable(n, setting["integration"])
        tip = system.AddSensor(
            items.SensorNode(
                nodeNumber=nodes[-1],
                storeInternal=True,
                writeToFile=False,
                outputVariableType=exu.OutputVariableType.Position,
            )
        )
        system.Assemble()
        # released on the mode's shape: places at equal arc length, slopes of length 1
        start = []
        x = 0.0
        for i in range(n + 1):
            if i > 0:
                rise = mode(i / n) - mode((i - 1) / n)
                x += ((LENGTH / n) ** 2 - rise**2) ** 0.5
            slope = mode_slope(i / n)
            long = (1.0 + slope**2) ** 0.5
            start += [x - LENGTH * i / n, mode(i / n), 1.0 / long - 1.0, slope / long]
        system.systemData.SetODE2Coordinates(start, exu.ConfigurationType.Initial)
        settings = settings_of(setting)
        time = settings.timeIntegration
        time.numberOfSteps = count
        time.endTime = PERIODS * PERIOD
        time.generalizedAlpha.spectralRadius = setting["radius"]
        time.newton.useModifiedNewton = setting["modified"]
        time.newton.relativeTolerance = setting["tol"]
        time.newton.absoluteTolerance = 1e-12
        time.verboseMode = 0
        settings.solution.sensors.writePeriod = dt
        return container, system, tip, settings

    def solve(model):
        _, system, tip, settings = model
        if not system.SolveDynamic(settings):
            raise RuntimeError("Newton's method does not converge")
        return system.GetSensorStoredData(tip)

    def judge(model, data):
        iterations = model[1].sys["dynamicSolver"].it.newtonStepsCount
        return {"error": vibration_error(data[:, 0], data[:, 2]), "steps": count, "iterations": iterations}

    return prepare, solve, judge


def p1_setting(a, n):
    linear = "dense" if n <= 8 else "sparse"
    return {"n": n, "a": a, "loads": 1 if a == 1 else 2, "tol": 1e-10, "linear": linear, "integration": 2}


def p2_setting(n, per_period):
    return {
        "n": n, "per_period": per_period, "tol": 1e-6, "linear": "dense", "integration": 1, "radius": 1, "modified": True,
    }


SETTINGS = {
    "P1": [p1_setting(a, n) for a in (1, 5, 10) for n in (4, 6, 8, 12, 16, 32, 64)],
    "P2": [p2_setting(*s) for s in ((2, 50), (2, 100), (3, 200), (4, 400), (4, 800), (6, 1600))],
}
QUICK = {"P1": [p1_setting(10, 8)], "P2": [p2_setting(2, 100)]}

if __name__ == "__main__":
    peer.main("exudyn", {"P1": p1, "P2": p2}, SETTINGS, QUICK)
