//! The device that cases are run on, made when it is first needed and kept from case to case.

use super::case::Stop;
use crate::gpu::{self, Caps, Headless};
use crate::offscreen::Renderer;
use crate::picture::{LayerKind, Picture};
use crate::scene::Scene;
use crate::technique::blend::Drawn;
use crate::technique::{self, Settings, merge};

type Make = Box<dyn FnMut(Lower) -> Result<Headless, gpu::Error>>;

/// The limits of a run, made stricter.
pub type Lower = fn(Caps) -> Caps;

/// What draws a scene where no device does.
pub type Draw = fn(&Scene) -> Result<Picture, technique::Error>;

/// A device, and the seed of what is random in a case.
pub struct TestBed {
    make: Make,
    draw: Option<Draw>,
    device: Option<Headless>,
    /// What is random follows from it alone.
    pub seed: u64,
}

impl TestBed {
    /// Devices come from `make`, which lowers the limits of the run as it is told.
    pub fn new(
        seed: u64,
        make: impl FnMut(Lower) -> Result<Headless, gpu::Error> + 'static,
    ) -> Self {
        Self {
            make: Box::new(make),
            draw: None,
            device: None,
            seed,
        }
    }

    /// No device: pictures are drawn by `draw`, a CPU reference of [`crate::offscreen::reference`], which cases of pictures
    /// judge as they judge a device.
    pub fn without_device(seed: u64, draw: Draw) -> Self {
        let none = |_: Lower| Err(gpu::Error::NoDriver);
        let mut bed = Self::new(seed, none);
        bed.draw = Some(draw);
        bed
    }

    /// Whether there is a device, or should be.
    pub fn wants_device(&self) -> bool {
        self.draw.is_none()
    }

    /// Bits of the weights of the device's sampler; those of f32 where there is none.
    ///
    /// # Errors
    /// Where there is no device and should be.
    pub fn subtexel_bits(&mut self) -> Result<u32, gpu::Error> {
        match self.draw {
            Some(_) => Ok(f32::MANTISSA_DIGITS - 1),
            None => Ok(self.device()?.gpu().limits().subtexel_bits),
        }
    }

    /// Whether slices of such a picture are blended in 16-bit floats, and merged by batches.
    ///
    /// # Errors
    /// Where there is no device and should be.
    pub fn is_merged(&mut self, settings: &Settings) -> Result<bool, gpu::Error> {
        if self.draw.is_some() || settings.technique.casts_rays() {
            return Ok(false);
        }
        let drawn = Drawn::Picture(settings.mode);
        Ok(merge::is_merged(self.device()?.gpu(), drawn))
    }

    /// The device.
    ///
    /// # Errors
    /// Where there is none.
    pub fn device(&mut self) -> Result<&mut Headless, gpu::Error> {
        if self.device.is_none() {
            self.device = Some((self.make)(|caps| caps)?);
        }
        Ok(self.device.as_mut().expect("made above"))
    }

    /// Forgets the device: the next case has a new one.
    pub fn drop_device(&mut self) {
        self.device = None;
    }

    /// A picture of a scene of one volume.
    ///
    /// # Errors
    /// Those of [`Renderer::render`].
    pub fn render(&mut self, scene: &Scene, layers: &[LayerKind]) -> Result<Picture, Stop> {
        if let Some(draw) = self.draw {
            let refused = |error: technique::Error| Stop::Suite(error.to_string());
            let mut picture = draw(scene).map_err(refused)?;
            let place = |kind: &LayerKind| picture.layers.iter().position(|l| l.kind == *kind);
            let places: Vec<_> = layers.iter().filter_map(place).collect();
            picture.layers = places.iter().map(|&i| picture.layers[i].clone()).collect();
            return Ok(picture);
        }
        self.with_renderer(scene, |renderer| {
            Ok(renderer.render(scene, layers)?.picture)
        })
    }

    /// The same picture by a second device of lower limits, which is gone afterwards.
    ///
    /// # Errors
    /// Those of [`Renderer::render`], and where the validation layer complains.
    pub fn render_lowered(&mut self, lower: Lower, scene: &Scene) -> Result<Picture, Stop> {
        if self.draw.is_some() {
            return self.render(scene, &[]);
        }
        let mut renderer = Renderer::several((self.make)(lower)?, scene.volumes())?;
        let picture = renderer.render(scene, &[])?.picture;
        match renderer.device().take_validation_messages().first() {
            Some(message) => Err(Stop::Suite(message.to_string())),
            None => Ok(picture),
        }
    }

    /// A renderer of the scene's volumes, for as long as `work` wants it.
    ///
    /// # Errors
    /// Those of `work`, and of making a renderer.
    pub fn with_renderer<T>(
        &mut self,
        scene: &Scene,
        work: impl FnOnce(&mut Renderer) -> Result<T, Stop>,
    ) -> Result<T, Stop> {
        self.device()?;
        let device = self.device.take().expect("made above");
        // Where this fails the device is gone with it, and the next case has a new one.
        let mut renderer = Renderer::several(device, scene.volumes())?;
        let done = work(&mut renderer);
        self.device = Some(renderer.into_device());
        done
    }

    /// Numbers of the seed and a name: the same in every run.
    pub fn random(&self, name: &str) -> Random {
        let mut state = self.seed;
        for byte in name.bytes() {
            state = (state ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
        Random(state)
    }
}

impl std::fmt::Debug for TestBed {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("TestBed")
            .field("device", &self.device)
            .field("seed", &self.seed)
            .finish_non_exhaustive()
    }
}

/// SplitMix64 (Steele, Lea and Flood 2014).
#[derive(Clone, Copy, Debug)]
pub struct Random(u64);

impl Random {
    /// The next 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// From 0 (included) to 1 (excluded), of 24 bits: an f32 holds it.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 40) as f64 / f64::from(1u32 << 24)
    }

    /// A whole number below `n`.
    pub fn below(&mut self, n: u32) -> u32 {
        (((self.bits() >> 32) * u64::from(n)) >> 32) as u32
    }
}
