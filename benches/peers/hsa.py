"""The paper's 4-rod robot in HSA-PyElastica, as auxetica.rs has it; one JSON object.

Its law takes the twist of the step before, so it lags by one step: after 2001 steps of 4e-5 s the platform is within
1e-8 of the way moved of where Auxetica has it after 2000; after 2000 it is 5e-4 of the way behind.
"""

import json
import math
import statistics
import tempfile
import time

import numpy as np
from elastica.timestepper import extend_stepper_interface
from hsa_elastica.simulation.hsa_robot_simulator import HsaRobotSimulator

BATCHES, STEPS, DT = 10, 200, 4e-5
ANGLE = math.radians(179.9)


def rod(index):
    """A rod of the paper's section II-E, with the stiffnesses of the authors' runs."""
    return {
        "num_elements": 25,
        "printed_length": 0.1,
        "outside_radius": 0.0127,
        "wall_thickness": 0.00243,
        "radial_offset": 0.024,
        "phi": math.pi / 4 + index * math.pi / 2,
        "handedness": ["right", "left"][index % 2],
        "material_density": 1050.0,
        "elastic_modulus": 1e7,
        "elastic_modulus_scale_factor": 0.0,
        "shear_modulus": 8e5,
        "bend_rigidity": 0.02,
        "twist_rigidity": 0.014,
        "rest_lengths_scale_factor": 0.01,
        "translational_damping_constant": [8e3, 8e3, 1e4],
        "rotational_damping_constant": [5.0, 5.0, 7.0],
    }


platform = {"radius": 0.0475, "thickness": 0.003, "density": 700.0}
segment = {"printed_length": 0.1, "platform": platform, "rods": [rod(i) for i in range(4)]}
robot = {"num_rods_per_segment": 4, "segments": [segment]}
with tempfile.TemporaryDirectory() as logs:
    # one diagnostic a second, so that none is in what is measured but the first
    simulator = HsaRobotSimulator("robot", robot, duration=1.0, dt=DT, fps=1.0, log_dir=logs)
simulator.configure(add_constraints=False, finalize=False)
angles = np.array([[ANGLE, -ANGLE, ANGLE, -ANGLE]])
simulator.add_controlled_boundary_conditions(angles, ramp_up_time=5.0)
simulator.finalize()
step, stages = extend_stepper_interface(simulator.timestepper, simulator)
body = simulator.segments[0]["platform"]
start = body.position_collection[:, 0].copy()
now, seconds = 0.0, []
for _ in range(BATCHES):
    begin = time.perf_counter()
    for _ in range(STEPS):
        now = step(simulator.timestepper, stages, simulator, now, DT)
    seconds.append(time.perf_counter() - begin)
moved = body.position_collection[:, 0] - start
us = 1e6 * statistics.median(seconds[1:]) / STEPS
print(json.dumps({"name": "4 x 25 HSA robot", "us": us, "moved": moved.tolist()}))
