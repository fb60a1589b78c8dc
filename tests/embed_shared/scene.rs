//! What the hosts of these tests show, and how they put it on their device.

use super::Host;
use crate::shared::{oblique_camera, projections, ramps, volume_of, waves};
use glam::{DAffine3, DMat3, DVec3, dvec3};
use stratavox::camera::Camera;
use stratavox::offscreen::reference;
use stratavox::resident::{GpuTransfer, GpuVolume};
use stratavox::scene::Scene;
use stratavox::technique::{Settings, View};
use stratavox::transfer::TransferFunction;
use stratavox::volume::{Grid, Volume};

/// A volume whose values vary along every axis and fade to 0, which is transparent, towards its box: whether
/// rounding takes a sample at the box in or leaves it out then changes no picture.
pub struct Stage {
    pub volume: Volume,
    pub grid: Grid,
    pub camera: Camera,
    pub transfer: TransferFunction,
    pub settings: Settings,
    pub extent: [u32; 2],
}

impl Stage {
    pub fn new(settings: Settings) -> Self {
        let dims = [19, 22, 16];
        let far = DVec3::from_array(dims.map(f64::from));
        // Voxels from the box on to where values are whole: steepest slope 1 / FADE.
        const FADE: f64 = 3.0;
        let fading = move |p: DVec3| {
            let inside = (p - 0.5).min(far - 0.5 - p).min_element();
            (inside / FADE).min(1.0) * waves(p)
        };
        let m = DMat3::from_cols(
            dvec3(1.1, 0.2, -0.1),
            dvec3(-0.3, 0.9, 0.2),
            dvec3(0.1, 0.3, 1.3),
        );
        let affine = DAffine3::from_mat3_translation(m, dvec3(20.0, -8.0, 60.0));
        let volume = volume_of(dims, affine, fading);
        let grid = volume.grid();
        Self {
            camera: Camera {
                zoom: 1.8,
                ..oblique_camera(&grid, projections(&grid)[1])
            },
            grid,
            volume,
            transfer: ramps(),
            settings: Settings {
                conformance: true,
                ..settings
            },
            extent: [44, 36],
        }
    }

    pub fn view(&self) -> View<'_> {
        View {
            grid: &self.grid,
            camera: &self.camera,
            extent_pixels: self.extent,
            in_pixel: [0.0; 2].into(),
            settings: &self.settings,
        }
    }

    /// What the CPU reference computes: premultiplied colour of each pixel.
    pub fn reference(&self) -> Vec<[f32; 4]> {
        let scene = Scene {
            beside: Default::default(),
            volume: &self.volume,
            transfer: Some(&self.transfer),
            camera: &self.camera,
            extent_pixels: self.extent,
            settings: &self.settings,
        };
        let pixels = reference::render::<f32>(&scene).unwrap().pixels;
        let drawn = pixels.iter().filter(|pixel| pixel[3] > 0.1).count();
        assert!(drawn > 300, "only {drawn} pixels show anything");
        pixels
    }
}

/// A stage's volume and transfer function on a host's device.
pub struct OnDevice {
    pub volume: GpuVolume,
    pub transfer: GpuTransfer,
}

impl OnDevice {
    /// Uploads in a submission of the host's.
    pub fn new(host: &Host, stage: &Stage) -> Self {
        let gpu = host.gpu();
        let volume = GpuVolume::new(gpu, &stage.volume, stage.view().texture_layout()).unwrap();
        let staging = volume.stage(&stage.volume).unwrap();
        let length = stage.grid.smallest_spacing();
        let space = stage.settings.color_space;
        let transfer = GpuTransfer::new(gpu, &stage.transfer, length, space).unwrap();
        // SAFETY: recorded outside rendering; all of it lives until `run` has waited.
        host.run(|cmd| unsafe {
            volume.record_upload_all(cmd, &staging).unwrap();
            transfer.record_upload(cmd).unwrap();
        });
        Self { volume, transfer }
    }
}
