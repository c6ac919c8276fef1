//! Energies of a system.

use crate::system::System;
use crate::view::ReadBody;

impl System {
    /// Kinetic energy \[J\] of all bodies.
    pub fn kinetic_energy(&self) -> f64 {
        self.ids()
            .iter()
            .map(|id| {
                let body = self.body(*id);
                let moving: f64 = (0..body.nodes())
                    .map(|i| body.mass(i) * body.velocity(i).norm_squared())
                    .sum();
                let turning: f64 = (0..body.directors())
                    .map(|e| {
                        let omega = body.omega(e);
                        omega.component_mul(&body.inertia(e)).dot(&omega) / body.dilatation(e)
                    })
                    .sum();
                (moving + turning) / 2.0
            })
            .sum()
    }

    /// Elastic energy \[J\] of all linear elastic rods, at the last evaluation.
    pub fn elastic_energy(&self) -> f64 {
        self.groups
            .iter()
            .map(|group| {
                let b = &group.bodies;
                let mut energy = 0.0;
                for layout in b.layouts() {
                    for k in layout.element_stations() {
                        let strain = b.sigma.get(k) - b.rest_sigma.get(k);
                        energy += b.stress.get(k).dot(&strain) * b.rest_length[k] / 2.0;
                    }
                    for k in layout.cells() {
                        let strain = b.kappa.get(k) - b.rest_kappa.get(k);
                        energy += b.couple.get(k).dot(&strain) * b.rest_voronoi[k] / 2.0;
                    }
                }
                energy
            })
            .sum()
    }
}
