use glam::DVec3;

/// Two unit vectors that complete a unit `normal` to a right-handed orthonormal frame.
///
/// Branchless and continuous except across `normal.z = 0⁻`.
///
/// Source: Duff et al. (2017), Building an orthonormal basis, revisited, JCGT 6(1).
#[must_use]
pub fn basis(normal: DVec3) -> (DVec3, DVec3) {
    let DVec3 { x, y, z } = normal;
    let sign = 1.0_f64.copysign(z);
    let a = -1.0 / (sign + z);
    let b = x * y * a;
    let tangent = DVec3::new(1.0 + sign * x * x * a, sign * b, -sign * x);
    let bitangent = DVec3::new(b, sign + y * y * a, -y);
    (tangent, bitangent)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_basis_is_orthonormal_and_right_handed_in_every_direction() {
        let steps = [-1.0, -1e-3, -1e-200, -0.0, 0.0, 1e-300, 0.2, 1.0];
        for x in steps {
            for y in steps {
                for z in steps {
                    let Some(n) = DVec3::new(x, y, z).try_normalize() else { continue };
                    let (t, b) = basis(n);
                    let rounding = 8.0 * f64::EPSILON;
                    assert!((t.cross(b) - n).length() < rounding, "{n}");
                    assert!((t.length() - 1.0).abs() < rounding, "{n}");
                    assert!(t.dot(n).abs() < rounding && b.dot(n).abs() < rounding, "{n}");
                }
            }
        }
    }
}
