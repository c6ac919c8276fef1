"""Clamped rods with an end force and damping in PyElastica, as auxetica.rs has them; one JSON object a line."""

import csv
import json
import statistics
import sys
import time

import elastica as ea
import numpy as np

BATCHES = 10


class System(ea.BaseSystemCollection, ea.Constraints, ea.Forcing, ea.Damping):
    """Rods and what acts on them."""


def measure(rods, elements, dt, steps):
    """Microseconds a step (median over all batches but the first), and how far the last rod's tip has moved."""
    system = System()
    all_rods = []
    for i in range(rods):
        rod = ea.CosseratRod.straight_rod(
            elements,
            np.array([0.2 * i, 0.0, 0.0]),
            np.array([0.0, 0.0, 1.0]),
            np.array([1.0, 0.0, 0.0]),
            1.0,
            0.05,
            1000.0,
            youngs_modulus=1e6,
            shear_modulus=4e5,
        )
        system.append(rod)
        all_rods.append(rod)
        system.constrain(rod).using(
            ea.OneEndFixedBC, constrained_position_idx=(0,), constrained_director_idx=(0,)
        )
        # full force from the first step on
        system.add_forcing_to(rod).using(
            ea.EndpointForces, np.zeros(3), np.array([1.0, 0.0, 0.0]), ramp_up_time=1e-12
        )
        system.dampen(rod).using(ea.AnalyticalLinearDamper, damping_constant=0.1, time_step=dt)
    system.finalize()
    stepper, now, seconds = ea.PositionVerlet(), np.float64(0.0), []
    start = all_rods[-1].position_collection[:, -1].copy()
    for _ in range(BATCHES):
        begin = time.perf_counter()
        for _ in range(steps):
            now = stepper.step(system, now, np.float64(dt))
        seconds.append(time.perf_counter() - begin)
    moved = all_rods[-1].position_collection[:, -1] - start
    return 1e6 * statistics.median(seconds[1:]) / steps, moved.tolist()


with open(sys.argv[1], newline="") as cases:
    for case in csv.DictReader(cases):
        rods, elements, steps = (int(case[key]) for key in ("rods", "elements", "steps"))
        us, moved = measure(rods, elements, float(case["dt"]), steps)
        name = f"{rods} x {elements} rods"
        print(json.dumps({"name": name, "us": us, "moved": moved}), flush=True)
