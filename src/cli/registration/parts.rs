//! ITK's linear transforms by their parameters, all x' = A (x - c) + t + c with c the fixed parameters.

use glam::{DAffine3, DMat3, DQuat, DVec3};

/// One transform of a file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Part {
    /// Its class: `AffineTransform_double_3_3`.
    pub class: String,
    /// What a registration finds.
    pub parameters: Vec<f64>,
    /// What it keeps.
    pub fixed: Vec<f64>,
}

impl Part {
    /// One without numbers.
    pub fn new(class: &str) -> Self {
        Self {
            class: class.to_owned(),
            ..Self::default()
        }
    }

    fn parameters<const N: usize>(&self) -> Result<[f64; N], String> {
        let found = self.parameters.len();
        let all = self.parameters.as_slice().try_into();
        all.map_err(|_| {
            format!(
                "{}: wanted {N} numbers as parameters, found {found}",
                self.class
            )
        })
    }

    /// c.
    fn center(&self) -> Result<DVec3, String> {
        match self.fixed[..] {
            [x, y, z] | [x, y, z, _] => Ok(DVec3::new(x, y, z)),
            _ => Err(format!(
                "{}: wanted the three coordinates of a centre as FixedParameters, found {} numbers",
                self.class,
                self.fixed.len()
            )),
        }
    }

    fn about_center(&self, matrix: DMat3, translation: [f64; 3]) -> Result<DAffine3, String> {
        let center = self.center()?;
        let offset = DVec3::from_array(translation) + center - matrix * center;
        Ok(DAffine3::from_mat3_translation(matrix, offset))
    }

    fn affine(&self) -> Result<DAffine3, String> {
        let (name, rest) = self.class.split_once('_').unwrap_or((&self.class, ""));
        if !matches!(rest, "double_3_3" | "float_3_3") {
            return Err(format!(
                "wanted a transform of three dimensions, as AffineTransform_double_3_3, found {:?}",
                self.class
            ));
        }
        match name {
            "AffineTransform" | "MatrixOffsetTransformBase" => {
                let [a, b, c, d, e, f, g, h, i, x, y, z] = self.parameters()?;
                let rows = DMat3::from_cols_array(&[a, b, c, d, e, f, g, h, i]);
                self.about_center(rows.transpose(), [x, y, z])
            }
            "TranslationTransform" => Ok(DAffine3::from_translation(DVec3::from_array(
                self.parameters()?,
            ))),
            "Euler3DTransform" => {
                let [x, y, z, t @ ..] = self.parameters::<6>()?;
                let [about_x, about_y, about_z] = [
                    DMat3::from_rotation_x(x),
                    DMat3::from_rotation_y(y),
                    DMat3::from_rotation_z(z),
                ];
                // The fourth of what is fixed says the order.
                let is_zyx = self.fixed.get(3).is_some_and(|&flag| flag != 0.0);
                let inner = if is_zyx {
                    about_y * about_x
                } else {
                    about_x * about_y
                };
                self.about_center(about_z * inner, t)
            }
            "VersorRigid3DTransform" => {
                let [x, y, z, t @ ..] = self.parameters::<6>()?;
                self.about_center(self.versor([x, y, z])?, t)
            }
            "Similarity3DTransform" => {
                let [x, y, z, tx, ty, tz, scale] = self.parameters()?;
                self.about_center(self.versor([x, y, z])? * scale, [tx, ty, tz])
            }
            _ => Err(format!(
                "wanted a linear transform (AffineTransform, MatrixOffsetTransformBase, TranslationTransform, \
                 Euler3DTransform, VersorRigid3DTransform, Similarity3DTransform or a CompositeTransform of them), found {name:?}"
            )),
        }
    }

    /// A rotation by the first three numbers of a unit quaternion, the last of which is not negative.
    fn versor(&self, [x, y, z]: [f64; 3]) -> Result<DMat3, String> {
        let square = x * x + y * y + z * z;
        if square > 1.0 + 1e-9 {
            return Err(format!(
                "{}: wanted a versor no longer than 1, found {x} {y} {z}",
                self.class
            ));
        }
        let w = (1.0 - square).max(0.0).sqrt();
        Ok(DMat3::from_quat(DQuat::from_xyzw(x, y, z, w).normalize()))
    }
}

/// All of a file as one: the last of a composite is done first (`itk::CompositeTransform`).
pub fn composed(parts: &[Part]) -> Result<DAffine3, String> {
    let is_composite = |part: &Part| part.class.starts_with("CompositeTransform_");
    match parts {
        [] => Err("wanted `Transform:` and its parameters, found none".into()),
        [first, rest @ ..] if is_composite(first) && !rest.is_empty() => {
            let all = rest.iter().map(Part::affine);
            all.reduce(|outer, inner| Ok(outer? * inner?))
                .expect("at least one")
        }
        [one] => one.affine(),
        _ => Err(format!(
            "wanted one transform, or a CompositeTransform before several, found {}",
            parts.len()
        )),
    }
}
