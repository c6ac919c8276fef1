//! What a straight rod is made of: geometry, material and rigid ends, element by element.

use nalgebra::Vector3;

/// Timoshenko's shear correction of a circular section (Gazzola et al. 2018, section 2.5.2).
pub const SHEAR_CORRECTION: f64 = 27.0 / 28.0;

/// A straight rod along `direction`, cut into equal elements. Every `Vec` has one entry an element.
#[derive(Clone, Debug, PartialEq)]
pub struct Rod {
    /// Unique name.
    pub name: String,
    /// Position of the first node in the world frame \[m\].
    pub start: Vector3<f64>,
    /// Unit tangent of the undeformed rod (director `d3`) in the world frame.
    pub direction: Vector3<f64>,
    /// Unit vector normal to `direction` (director `d1`) in the world frame.
    pub normal: Vector3<f64>,
    /// Length between first and last node, undeformed \[m\]; rigid ends not counted.
    pub length: f64,
    /// Outside radius of the section \[m\].
    pub outside_radius: Vec<f64>,
    /// Inside radius of the section \[m\], 0 for a solid rod.
    pub inside_radius: Vec<f64>,
    /// Density \[kg/m3\].
    pub density: Vec<f64>,
    /// Rigidities of the shear and stretch strains along `d1, d2, d3` \[N\].
    pub shear_stretch: Vec<Vector3<f64>>,
    /// Rigidities of bending about `d1, d2` and twist about `d3` \[N m2\].
    pub bend_twist: Vec<Vector3<f64>>,
    /// Intrinsic shear and stretch strains (0 for none) \[-\].
    pub rest_sigma: Vector3<f64>,
    /// Intrinsic curvatures and twist \[rad/m\].
    pub rest_kappa: Vector3<f64>,
    /// Lengths of the rigid ends before the first and after the last node \[m\].
    pub caps: [f64; 2],
}

/// A circular section, solid or hollow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Section {
    /// Outside radius \[m\].
    pub outside: f64,
    /// Inside radius \[m\], 0 if solid.
    pub inside: f64,
}

impl Section {
    /// Area \[m2\].
    pub fn area(&self) -> f64 {
        std::f64::consts::PI * (self.outside.powi(2) - self.inside.powi(2))
    }

    /// Second moments of area about `d1, d2, d3` \[m4\].
    pub fn second_moment(&self) -> Vector3<f64> {
        let bending = std::f64::consts::FRAC_PI_4 * (self.outside.powi(4) - self.inside.powi(4));
        Vector3::new(bending, bending, 2.0 * bending)
    }

    /// Rigidities \[N\] and \[N m2\] of an isotropic material of Young's modulus `youngs` and shear modulus `shear`
    /// \[Pa\] (Gazzola et al. 2018, table 1).
    pub fn rigidities(&self, youngs: f64, shear: f64) -> (Vector3<f64>, Vector3<f64>) {
        let (a, i) = (self.area(), self.second_moment());
        let lateral = SHEAR_CORRECTION * shear * a;
        (
            Vector3::new(lateral, lateral, youngs * a),
            Vector3::new(youngs * i.x, youngs * i.y, shear * i.z),
        )
    }
}

impl Rod {
    /// A uniform rod from the world's origin along z, `d1` along x, without rigid ends or intrinsic strains.
    pub fn uniform(
        name: &str,
        length: f64,
        elements: usize,
        section: Section,
        density: f64,
        (shear_stretch, bend_twist): (Vector3<f64>, Vector3<f64>),
    ) -> Self {
        Self {
            name: name.into(),
            start: Vector3::zeros(),
            direction: Vector3::z(),
            normal: Vector3::x(),
            length,
            outside_radius: vec![section.outside; elements],
            inside_radius: vec![section.inside; elements],
            density: vec![density; elements],
            shear_stretch: vec![shear_stretch; elements],
            bend_twist: vec![bend_twist; elements],
            rest_sigma: Vector3::zeros(),
            rest_kappa: Vector3::zeros(),
            caps: [0.0; 2],
        }
    }

    /// Number of elements.
    pub fn elements(&self) -> usize {
        self.density.len()
    }

    /// Section of element `e`.
    pub fn section(&self, e: usize) -> Section {
        Section {
            outside: self.outside_radius[e],
            inside: self.inside_radius[e],
        }
    }

    /// The first thing that is wrong with the rod, in words.
    pub fn check(&self) -> Result<(), String> {
        let n = self.elements();
        if n == 0 {
            return Err("a rod needs at least one element".into());
        }
        let lengths = [
            ("outside_radius", self.outside_radius.len()),
            ("inside_radius", self.inside_radius.len()),
            ("shear_stretch", self.shear_stretch.len()),
            ("bend_twist", self.bend_twist.len()),
        ];
        if let Some((field, len)) = lengths.into_iter().find(|(_, len)| *len != n) {
            return Err(format!("`{field}` has {len} entries for {n} elements"));
        }
        let positive = |what: &str, value: f64| {
            if value > 0.0 && value.is_finite() {
                Ok(())
            } else {
                Err(format!("{what} must be positive and finite, it is {value}"))
            }
        };
        positive("the length [m]", self.length)?;
        for e in 0..n {
            positive("the outside radius [m]", self.outside_radius[e])?;
            positive("the density [kg/m3]", self.density[e])?;
            let inside = self.inside_radius[e];
            if !(0.0..self.outside_radius[e]).contains(&inside) {
                return Err(format!(
                    "the inside radius {inside} m must lie between 0 and the outside radius {} m",
                    self.outside_radius[e]
                ));
            }
            for rigidity in self.shear_stretch[e].iter() {
                positive("a shear or axial rigidity [N]", *rigidity)?;
            }
            for rigidity in self.bend_twist[e].iter() {
                positive("a bending or twist rigidity [N m2]", *rigidity)?;
            }
        }
        if (self.direction.norm() - 1.0).abs() > 1e-9
            || (self.normal.norm() - 1.0).abs() > 1e-9
            || self.direction.dot(&self.normal).abs() > 1e-9
        {
            return Err("direction and normal must be unit vectors at a right angle".into());
        }
        if self.caps.iter().any(|c| !(*c >= 0.0 && c.is_finite())) {
            return Err(format!("rigid ends can't have lengths {:?} m", self.caps));
        }
        Ok(())
    }
}
