"""Drives an instance along sampled signals, sample by sample."""

INPUTS = ("spindle_speed", "nozzle_position")


def inputs_at(signals, k):
    return {name: float(signals[name][k]) for name in INPUTS}


def start(slave, signals, **parameters):
    slave.start(inputs=inputs_at(signals, 0), **parameters)


def step(slave, signals, k, size):
    slave.set(**inputs_at(signals, k))
    slave.fmu.doStep(float(signals["time"][k]), size)


def run(slave, signals, size, **parameters):
    """Outputs at every communication point, the start included."""
    start(slave, signals, **parameters)
    rows = [slave.outputs()]
    for k in range(len(signals) - 1):
        step(slave, signals, k, size)
        rows.append(slave.outputs())
    return rows
