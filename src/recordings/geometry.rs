//! Measures of the recorded robot.

use nalgebra::Vector3;

/// Measures of the robot that the recordings need, by default those of the recorded one (m).
///
/// The base plane is at z = 0 and the robot extends along +z: rigid proximal ends of the rods,
/// flexible rods, rigid distal ends, platform.
#[derive(Debug, Clone, PartialEq)]
pub struct RobotGeometry {
    /// Where each rod's axis crosses the base plane (m): x and y.
    pub rods: [[f64; 2]; 4],
    /// Index of the rod that carries the ring.
    pub ring_rod: usize,
    /// Length of the rigid end of a rod at the base (m).
    pub proximal_end: f64,
    /// Length of the rigid end of a rod at the platform (m).
    pub distal_end: f64,
    /// Thickness of the platform (m).
    pub platform_thickness: f64,
    /// Height of the platform's markers above its outer face (m).
    pub platform_markers: f64,
    /// Height of the base's markers above the base plane (m).
    pub base_markers: f64,
}

impl Default for RobotGeometry {
    fn default() -> Self {
        let r = 0.024;
        Self {
            rods: [[r, r], [-r, r], [-r, -r], [r, -r]],
            ring_rod: 2,
            proximal_end: 0.025,
            distal_end: 0.020,
            platform_thickness: 0.007,
            platform_markers: 0.0075,
            base_markers: 0.0035,
        }
    }
}

impl RobotGeometry {
    /// Where the flexible part of the ring's rod begins (m), in the base frame.
    #[must_use]
    pub fn ring_rod_base(&self) -> Vector3<f64> {
        let [x, y] = self.rods[self.ring_rod];
        Vector3::new(x, y, self.proximal_end)
    }

    /// From the end of the flexible part of the ring's rod to the point on the platform's axis at
    /// the height of its markers (m), in the platform's frame.
    #[must_use]
    pub fn tip_to_markers(&self) -> Vector3<f64> {
        let [x, y] = self.rods[self.ring_rod];
        let height = self.distal_end + self.platform_thickness + self.platform_markers;
        Vector3::new(-x, -y, height)
    }
}
