//! Where a registration puts a volume: linear transforms in ITK's files, as ANTs, SimpleITK and 3D Slicer write them.
//!
//! A file maps places of the fixed volume to places of the moving one, in millimetres of LPS+:
//! x' = A (x - c) + t + c (`itk::MatrixOffsetTransformBase`). What puts the moving volume into the world of the fixed one is
//! the inverse, in RAS+: F (moving_from_fixed)^-1 F, F = diag(-1, -1, 1).

mod matlab;
mod parts;
mod text;

use super::{Error, small_file::parsed};
use crate::format::geometry::{RAS_FROM_LPS, is_invertible};
use glam::{DAffine3, DMat3};
use std::path::Path;

/// A linear transform takes some hundred bytes.
const MAX_FILE_BYTES: u64 = 1 << 16;

/// World of the fixed volume from that of the moving one, RAS+, in millimetres.
///
/// # Errors
/// [`Error::Input`] where the file is none of ITK's, holds what is not linear, or flattens space.
pub fn read(path: &Path) -> Result<DAffine3, Error> {
    parsed(
        path,
        "a linear transform",
        MAX_FILE_BYTES,
        fixed_from_moving,
    )
}

fn fixed_from_moving(bytes: &[u8]) -> Result<DAffine3, String> {
    let parts = match bytes {
        [b'#', ..] => text::parts(bytes)?,
        [0x89, b'H', b'D', b'F', ..] => {
            return Err(
                "wanted a text or MATLAB file of ITK, found HDF5: written as .tfm it can be read"
                    .into(),
            );
        }
        _ if matlab::is_one(bytes) => matlab::parts(bytes)?,
        _ => {
            return Err(format!(
                "wanted a transform of ITK, which begins with {:?}, found something else: FSL's matrices are of scaled \
                 voxels, `c3d_affine_tool -fsl2ras -oitk` converts them",
                text::FIRST_LINE
            ));
        }
    };
    let moving_from_fixed = parts::composed(&parts)?;
    if !is_invertible(&moving_from_fixed) {
        return Err(format!(
            "wanted a matrix with an inverse, found {}",
            moving_from_fixed.matrix3
        ));
    }
    let flip = DAffine3::from_mat3(DMat3::from_diagonal(RAS_FROM_LPS));
    Ok(flip * moving_from_fixed.inverse() * flip)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DVec3, dvec3};

    fn text(transform: &str) -> Vec<u8> {
        format!("#Insight Transform File V1.0\n#Transform 0\n{transform}\n").into_bytes()
    }

    /// Numbers of SimpleITK 2.5: the place of the moving volume that a point of the fixed one goes to, both in LPS+.
    #[test]
    fn transforms_do_what_itk_does() {
        let at = dvec3(10.0, -20.0, 30.0);
        for (transform, wanted) in CASES {
            let found = fixed_from_moving(&text(transform)).expect(transform);
            let wanted = RAS_FROM_LPS * DVec3::from_array(*wanted);
            let moved = RAS_FROM_LPS * found.transform_point3(wanted);
            assert!((moved - at).length() < 1e-9, "{transform}: {moved}");
        }
    }

    #[test]
    fn what_is_no_linear_transform_is_refused_by_its_part() {
        let affine = "Transform: AffineTransform_double_3_3\nParameters: 1 0 0 0 1 0 0 0 1 0 0 0\n";
        let flat = "Transform: AffineTransform_double_3_3\nParameters: 1 0 0 2 0 0 0 0 1 0 0 0\nFixedParameters: 0 0 0";
        for (bytes, wanted) in [
            (text(affine), "FixedParameters"),
            (text(flat), "with an inverse"),
            (
                text("Transform: BSplineTransform_double_3_3\nParameters: 1\nFixedParameters: 1"),
                "BSplineTransform",
            ),
            (
                text("Transform: AffineTransform_double_2_2\nParameters: 1\nFixedParameters: 1"),
                "three dimensions",
            ),
            (text(&affine.replace("0 0 0\n", "0 0 x\n")), "\"x\""),
            (
                text(&affine.replace(" 0 0 0\n", " 0 0\nFixedParameters: 0 0 0")),
                "12 numbers",
            ),
            (text(""), "Transform:"),
            (text("Parameters: 1"), "Transform:"),
            (
                text(&format!(
                    "{affine}FixedParameters: 0 0 0\n{affine}FixedParameters: 0 0 0"
                )),
                "Composite",
            ),
            (
                text(
                    "Transform: Euler3DTransform_double_3_3\nParameters: nan 0 0 0 0 0\nFixedParameters: 0 0 0",
                ),
                "with an inverse",
            ),
            (
                text(
                    "Transform: VersorRigid3DTransform_double_3_3\nParameters: 1 1 0 0 0 0\nFixedParameters: 0 0 0",
                ),
                "versor",
            ),
            (b"1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n".to_vec(), "FSL"),
            (b"\x89HDF\r\n".to_vec(), "HDF5"),
            (Vec::new(), "ITK"),
        ] {
            let problem = fixed_from_moving(&bytes).expect_err(wanted);
            assert!(problem.contains(wanted), "{wanted}: {problem}");
        }
    }

    const CASES: &[(&str, [f64; 3])] = &[
        (
            "Transform: AffineTransform_double_3_3\n\
             Parameters: 0.9 0.1 -0.2 0.05 1.1 0.3 -0.1 0.2 0.95 3 -4 5\n\
             FixedParameters: 7 8 -9",
            [2.1000000000000005, -14.950000000000001, 27.15],
        ),
        (
            "Transform: TranslationTransform_double_3_3\n\
             Parameters: 1.5 -2.5 3.5\n\
             FixedParameters: ",
            [11.5, -22.5, 33.5],
        ),
        (
            "Transform: Euler3DTransform_double_3_3\n\
             Parameters: 0.3 -0.4 0.5 1 2 3\n\
             FixedParameters: 4 5 6 0",
            [16.561175512485953, -22.129779604067874, 24.962304375870236],
        ),
        (
            "Transform: Euler3DTransform_double_3_3\n\
             Parameters: 0.3 -0.4 0.5 1 2 3\n\
             FixedParameters: 4 5 6 1",
            [19.389710035381803, -20.435712318710337, 25.649862902216285],
        ),
        (
            "Transform: VersorRigid3DTransform_double_3_3\n\
             Parameters: 0.0916432938695913 0.1832865877391826 0.2749298816087739 1 2 3\n\
             FixedParameters: 4 -5 6",
            [26.407529462826528, -13.893168608422387, 25.126269251339416],
        ),
        (
            "Transform: Similarity3DTransform_double_3_3\n\
             Parameters: 0.3487482865070052 -0.23249885767133677 0.11624942883566838 -1 2 3 1.25\n\
             FixedParameters: 4 5 -6",
            [5.903455723568223, -46.1450525978942, 11.99952763350694],
        ),
        (
            "Transform: CompositeTransform_double_3_3\n\
             Transform: VersorRigid3DTransform_double_3_3\n\
             Parameters: 0.0916432938695913 0.1832865877391826 0.2749298816087739 1 2 3\n\
             FixedParameters: 4 -5 6\n\
             Transform: AffineTransform_double_3_3\n\
             Parameters: 0.9 0.1 -0.2 0.05 1.1 0.3 -0.1 0.2 0.95 3 -4 5\n\
             FixedParameters: 7 8 -9",
            [16.66877867888393, -13.833873932083968, 26.21632306176133],
        ),
    ];
}
