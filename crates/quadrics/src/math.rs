//! The words of geometry that every module speaks, named once.

pub mod lanes;
pub mod triangle;

/// A position.
pub type Point = nalgebra::Point3<f64>;
/// A displacement.
pub type Vector = nalgebra::Vector3<f64>;
/// A vector of length one.
pub type Unit = nalgebra::Unit<Vector>;
/// Uniform scale, rotation and translation: how the unit cube and the input's frame meet.
pub type Similarity = nalgebra::Similarity3<f64>;

/// Two unit vectors that make a right-handed orthonormal frame with `axis`.
pub fn frame(axis: &Unit) -> (Unit, Unit) {
    // The coordinate axis least aligned with `axis` is never parallel to it.
    let least = axis.iamin();
    let mut helper = Vector::zeros();
    helper[least] = 1.0;
    let u = Unit::new_normalize(axis.cross(&helper));
    let v = Unit::new_unchecked(axis.cross(&u));
    (u, v)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_is_orthonormal_and_right_handed() {
        for axis in [Vector::x(), Vector::y(), Vector::z(), Vector::new(1.0, -2.0, 0.5)] {
            let axis = Unit::new_normalize(axis);
            let (u, v) = frame(&axis);
            assert!(u.dot(&v).abs() < 1e-15 && u.dot(&axis).abs() < 1e-15);
            assert!((u.cross(&v) - axis.into_inner()).norm() < 1e-15);
        }
    }
}
