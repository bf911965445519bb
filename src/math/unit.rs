//! Unit vectors.

use glam::DVec3;

/// Returns the unit vector in the direction of `v`, and the length of `v`. No intermediate result
/// overflows.
pub fn unit(v: DVec3) -> (DVec3, f64) {
    let greatest = v.abs().max_element();
    let scaled = v / greatest;
    (scaled.normalize(), scaled.length() * greatest)
}
