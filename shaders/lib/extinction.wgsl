// Extinction per world length of an opacity: sigma = -ln(1 - min(opacity, 1 - 2^-12)) / d0. CPU reference: src/transfer/law.rs.

fn extinction_of(opacity: f32, reference_length: f32) -> f32 {
    return -log(1.0 - min(opacity, 1.0 - 1.0 / 4096.0)) / reference_length;
}
