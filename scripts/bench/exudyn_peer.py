#!/usr/bin/env python3
"""P1, P2 and P3 with Exudyn: ANCFCable2D, cubic in its two nodes' places and slopes, extensible, not shearable.

Tried, and the choice of each:
- integration over an element: full, reduced, Lobatto and Gauss (Exudyn's 0, 1, 2). P1 takes 2, ten times closer at
  the same number of elements; P2 takes 1, no further off and without the spurious modes that 2 may have.
- linear solver: dense and sparse. Dense up to 8 elements, sparse beyond.
- P1: load in 1, 2, 3 and 5 steps. The fewest that converge; tolerance 1e-10, since 1e-8 stops 5e-6 L away at a = 1.
- P2: generalised-alpha with spectral radius 1 (the trapezoidal rule) and 0.95 (no better); Newton's method full and
  modified (2 to 3 times faster); tolerances 1e-6 and 1e-8 (no difference). Two elements are within 1 % already.
- P3: line load per depth 1e9 and 1e10 N/m^2 (the softer one chatters), dashpot 0 to 1e5 of it, friction by slip
  speed, saturated at 0.3 % of the drawing speed; 2 and 4 contact points an element; normals of the circle, not of the
  segments; spectral radius 0 (with 0.5 the wire chatters at steps that 0 takes); Newton's method full and modified;
  50 um drawn, then the mean over 50 um. Fewer than 14 elements chatter whatever the rest, and most of the time goes
  into the first contact.
"""

import math

import exudyn as exu
import exudyn.itemInterface as items
from exudyn import beams

import peer
from problems import (
    BEND, EA, EI, FRICTION, HOLD, LEG, LENGTH, MASS, PERIOD, PERIODS, SPEED, STRING, mode, mode_slope, slip_error,
    steps_of, string, tip_error, tip_force, vibration_error,
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


# P3: line load per depth, N/m^2, and dashpot, N s/m^2; friction per slip speed, N s/m^2; way before the mean and under
# it, m
CONTACT = 1e10
DASHPOT = 1e5
STICK = 1e7
WAY = 50e-6


def p3(setting):
    n, points = setting["n"], setting["points"]
    length = 2.0 * LEG + math.pi * BEND
    h = length / n
    end = 2.0 * WAY / SPEED

    def prepare():
        container = exu.SystemContainer()
        system = container.AddSystem()
        ground = system.AddMarker(items.MarkerBodyRigid(bodyNumber=system.AddObject(items.ObjectGround())))
        nodes = [
            system.AddNode(items.NodePoint2DSlope1(referenceCoordinates=list(string(h * i)))) for i in range(n + 1)
        ]
        for pair in zip(nodes, nodes[1:]):
            element = system.AddObject(
                items.ObjectANCFCable2D(
                    length=h / (1.0 + HOLD / EA),
                    massPerLength=MASS,
                    bendingStiffness=STRING * EI,
                    axialStiffness=EA,
                    nodeNumbers=list(pair),
                    useReducedOrderIntegration=1,
                )
            )
            shape = system.AddMarker(items.MarkerBodyCable2DShape(bodyNumber=element, numberOfSegments=points))
            history = system.AddNode(
                items.NodeGenericData(
                    initialCoordinates=[0.1] * points + [-2.0] * points + [0.0] * points,
                    numberOfDataCoordinates=3 * points,
                )
            )
            system.AddObject(
                items.ObjectContactFrictionCircleCable2D(
                    markerNumbers=[ground, shape],
                    nodeNumber=history,
                    numberOfContactSegments=points,
                    contactStiffness=CONTACT * h / points,
                    contactDamping=DASHPOT * h / points,
                    frictionVelocityPenalty=STICK * h / points,
                    frictionCoefficient=FRICTION,
                    circleRadius=BEND,
                    useSegmentNormals=False,
                )
            )
        held = system.AddMarker(items.MarkerNodePosition(nodeNumber=nodes[0]))
        system.AddLoad(items.LoadForceVector(markerNumber=held, loadVector=[HOLD, 0, 0]))
        fixed = system.AddMarker(
            items.MarkerNodeCoordinate(nodeNumber=system.AddNode(items.NodePointGround()), coordinate=0)
        )
        drawn = system.AddMarker(items.MarkerNodeCoordinate(nodeNumber=nodes[-1], coordinate=0))
        pull = system.AddObject(
            items.ObjectConnectorCoordinate(markerNumbers=[fixed, drawn], offset=SPEED, velocityLevel=True)
        )
        force = system.AddSensor(
            items.SensorObject(
                objectNumber=pull, storeInternal=True, writeToFile=False, outputVariableType=exu.OutputVariableType.Force
            )
        )
        system.Assemble()
        settings = settings_of(setting)
        time = settings.timeIntegration
        time.numberOfSteps = setting["steps"]
        time.endTime = end
        time.generalizedAlpha.spectralRadius = 0.0
        time.newton.useModifiedNewton = True
        time.discontinuous.maxIterations = 10
        time.discontinuous.ignoreMaxIterations = True
        time.verboseMode = 0
        settings.solution.sensors.writePeriod = end / setting["steps"]
        return container, system, force, settings

    def solve(model):
        _, system, force, settings = model
        if not system.SolveDynamic(settings):
            raise RuntimeError("Newton's method does not converge")
        return system.GetSensorStoredData(force)

    def judge(model, data):
        counts = model[1].sys["dynamicSolver"].it
        mean = abs(data[data[:, 0] > 0.5 * end, 1]).mean()
        return {"error": slip_error(mean), "steps": setting["steps"], "iterations": counts.newtonStepsCount}

    return prepare, solve, judge


def p1_setting(a, n):
    linear = "dense" if n <= 8 else "sparse"
    return {"n": n, "a": a, "loads": 1 if a == 1 else 2, "tol": 1e-10, "linear": linear, "integration": 2}


def p2_setting(n, per_period):
    common = {"tol": 1e-6, "linear": "dense", "integration": 1, "radius": 1, "modified": True}
    return {"n": n, "per_period": per_period} | common


def p3_setting(n, points, steps):
    return {"n": n, "points": points, "steps": steps, "linear": "sparse"}


SETTINGS = {
    "P1": [p1_setting(a, n) for a in (1, 5, 10) for n in (4, 6, 8, 12, 16, 32, 64)],
    "P2": [p2_setting(*s) for s in ((2, 50), (2, 100), (3, 200), (4, 400), (6, 800), (8, 1600))],
    "P3": [p3_setting(*s) for s in ((14, 4, 20), (20, 2, 20), (20, 4, 20), (40, 2, 20))],
}
QUICK = {"P1": [p1_setting(10, 8)], "P2": [p2_setting(2, 100)], "P3": [p3_setting(14, 4, 20)]}

if __name__ == "__main__":
    peer.main("exudyn", {"P1": p1, "P2": p2, "P3": p3}, SETTINGS, QUICK)
