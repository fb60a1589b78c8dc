//! What each frame of a film shows: the flags of `render`, one set a frame.
//!
//! With `N` frames, frame `k` stands at `u = k / (N - 1)` of the film:
//!
//! ```text
//! --turntable N      azimuth + 360 k / N: the last frame is one step before the first
//! --times            time u (times - 1): alone, N is (times - 1) (K + 1) + 1 for K frames --between two times
//! --keyframes FILE   what the keys say at u
//! ```

use super::keyframes::{Keyframes, MAX_FRAMES, place_of_frame};
use super::tracks::Tracks;
use crate::{
    camera::Camera,
    cli::{
        Error, exaggerate,
        flags::{ClassificationFlags, Depth, SceneFlags, Subject},
    },
    technique::Settings,
    volume::{Grid, Header},
};

/// Which frames there are.
#[derive(Debug)]
pub struct Film {
    /// Frames of a full circle.
    pub turntable: Option<u32>,
    /// Time runs from the first to the last.
    pub times: bool,
    /// Frames between two times of it, where nothing else says how many frames there are.
    pub between: u32,
    /// What a file says.
    pub keyframes: Option<Keyframes>,
}

/// One frame.
#[derive(Clone, Debug)]
pub struct FilmFrame {
    /// Who looks.
    pub camera: Camera,
    /// What is computed.
    pub settings: Settings,
    /// How values are seen.
    pub classification: ClassificationFlags,
    /// The time, counted from 0; between two whole numbers lies a blend.
    pub time: f64,
}

impl Film {
    /// How many frames, once the number of times is known.
    pub fn frame_count(&self, header: &Header) -> Result<u32, Error> {
        if self.times && header.times < 2 {
            return Err(Error::usage(
                "--times: the input has one time",
                "--turntable 120 turns the camera",
            ));
        }
        let count = match (self.turntable, &self.keyframes) {
            (Some(count), _) => count,
            (None, Some(keyframes)) => keyframes.frame_count,
            (None, None) if self.times => (header.times - 1).saturating_mul(self.between + 1) + 1,
            (None, None) => {
                return Err(Error::usage(
                    "nothing says what changes from frame to frame",
                    "--turntable 120, --times or --keyframes FILE",
                ));
            }
        };
        if count > MAX_FRAMES {
            return Err(Error::TooMany {
                message: format!("{count} frames: a film has at most {MAX_FRAMES}"),
                hint: "fewer frames, in several films",
            });
        }
        Ok(count)
    }

    /// True where the film says which time a frame shows.
    pub fn changes_time(&self) -> bool {
        self.times || self.keys_change_time()
    }

    /// True where keys say where the camera stands or how near it is: no look fits it then.
    pub fn places_the_camera(&self) -> bool {
        self.some_track(Tracks::places_the_camera)
    }

    /// True where keys say over which values functions are spread.
    pub fn changes_window(&self) -> bool {
        self.some_track(|tracks| !tracks.window.is_empty())
    }

    /// True where keys say how values are seen.
    pub fn changes_function(&self) -> bool {
        self.some_track(|tracks| !tracks.functions.is_empty())
    }

    fn keys_change_time(&self) -> bool {
        self.some_track(|tracks| !tracks.time.is_empty())
    }

    fn some_track(&self, has: impl Fn(&Tracks) -> bool) -> bool {
        let keyframes = self.keyframes.as_ref();
        keyframes.is_some_and(|film| has(&film.tracks))
    }

    /// All frames of `scene`, checked, of a volume of this header that is drawn on `grid`.
    pub fn shots(
        &self,
        scene: &SceneFlags,
        depth: Depth,
        header: &Header,
        grid: &Grid,
    ) -> Result<Vec<FilmFrame>, Error> {
        if self.times && (scene.input.time.is_some() || self.keys_change_time()) {
            return Err(Error::usage(
                "--times shows all times, and --time or the keyframes name one",
                "leave out one of them",
            ));
        }
        let count = self.frame_count(header)?;
        let time = match &scene.input.time {
            Some(_) => scene.input.time(header)?.0,
            None => 0,
        };
        let maker = Maker {
            film: self,
            scene,
            depth,
            subject: Subject::new(grid, header.is_earth),
            spacing: grid.smallest_spacing(),
            times: header.times,
            time: f64::from(time),
            count,
        };
        (0..count)
            .map(|k| maker.shot(k).map_err(|error| self.of_frame(k, error)))
            .collect()
    }

    /// The same error, saying which frame it is about where that is not plain.
    fn of_frame(&self, k: u32, error: Error) -> Error {
        match error {
            Error::Usage { message, hint } if self.keyframes.is_some() => Error::Usage {
                message: format!("frame {k} of the keyframes: {message}"),
                hint,
            },
            error => error,
        }
    }
}

struct Maker<'a> {
    film: &'a Film,
    scene: &'a SceneFlags,
    depth: Depth,
    subject: Subject,
    spacing: f64,
    times: u32,
    time: f64,
    count: u32,
}

impl Maker<'_> {
    fn shot(&self, k: u32) -> Result<FilmFrame, Error> {
        let u = place_of_frame(k, self.count);
        let mut camera = self.scene.camera.clone();
        let mut sampling = self.scene.sampling.clone();
        let mut classification = self.scene.classification.clone();
        let mut time = self.time;
        if let Some(Keyframes { tracks, .. }) = &self.film.keyframes {
            camera = tracks.camera(&camera, u);
            sampling = tracks.sampling(&sampling, u);
            classification = tracks.classification(&classification, u, self.spacing);
            time = tracks.time.number(u).unwrap_or(time);
        }
        if let Some(count) = self.film.turntable {
            let degrees = 360.0 * f64::from(k) / f64::from(count);
            camera = camera.turned(degrees, &self.subject);
        }
        let last_time = f64::from(self.times - 1);
        if self.film.times {
            // In this order a film of as many frames as times shows each of them exactly.
            time = f64::from(k) * last_time / f64::from(self.count.max(2) - 1);
        }
        if !(0.0..=last_time).contains(&time) {
            return Err(Error::usage(
                format!("time {time}: the input has {}, counted from 0", self.times),
                "a smooth course may swing beyond its keys",
            ));
        }
        classification.check()?;
        let section = &self.scene.section;
        let mut settings = self.scene.settings_of(&sampling, self.depth)?;
        // Grain that stood still would be seen as a curtain before the moving picture.
        settings.jitter.frame = k;
        settings.path.seed = settings.path.seed.wrapping_add(k);
        if let Some(Keyframes { tracks, .. }) = &self.film.keyframes {
            tracks.light(&mut settings.shading, u)?;
        }
        let extent_pixels = self.scene.picture.extent_pixels()?;
        Ok(FilmFrame {
            camera: section.camera(&camera, &self.subject, extent_pixels, &mut settings)?,
            settings,
            classification,
            time,
        })
    }
}

/// The one time that all frames show, if it is one of the input's.
pub fn still_time(shots: &[FilmFrame]) -> Option<u32> {
    let time = shots.first()?.time;
    let is_still = time.fract() == 0.0 && shots.iter().all(|shot| shot.time == time);
    is_still.then_some(time as u32)
}

/// Where voxels are drawn: heights may be stretched.
pub fn grid(scene: &SceneFlags, header: &Header) -> Result<Grid, Error> {
    let grid = Grid {
        dims: header.dims,
        world_from_voxel: header.world_from_voxel,
    };
    let (factor, _) = exaggerate::factor(scene, &grid, header.is_earth)?;
    Ok(Grid {
        world_from_voxel: exaggerate::stretched(grid.world_from_voxel, factor),
        ..grid
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::volume::{Format, VoxelType};
    use glam::DAffine3;

    fn header(times: u32) -> Header {
        let header = Header::new(Format::Nrrd, [4, 4, 4], VoxelType::U8, DAffine3::IDENTITY);
        Header { times, ..header }
    }

    fn shots(film: &Film, scene: &SceneFlags, times: u32) -> Result<Vec<FilmFrame>, Error> {
        let header = header(times);
        film.shots(scene, Depth::Eight, &header, &grid(scene, &header)?)
    }

    fn times_of(film: &Film, times: u32) -> Vec<f64> {
        shots(film, &SceneFlags::default(), times)
            .expect("a film")
            .iter()
            .map(|shot| shot.time)
            .collect()
    }

    const TIMES: Film = Film {
        turntable: None,
        times: true,
        between: 0,
        keyframes: None,
    };

    #[test]
    fn every_time_is_shown_once_or_spread_over_the_frames_of_a_turn() {
        assert_eq!(times_of(&TIMES, 4), [0.0, 1.0, 2.0, 3.0]);
        let turn = |count| Film {
            turntable: Some(count),
            ..TIMES
        };
        assert_eq!(times_of(&turn(5), 3), [0.0, 0.5, 1.0, 1.5, 2.0]);
        for count in 2..200 {
            let wanted: Vec<_> = (0..count).map(f64::from).collect();
            assert_eq!(times_of(&turn(count), count), wanted);
        }
        assert_eq!(times_of(&turn(1), 3), [0.0]);
    }

    #[test]
    fn a_turn_has_equal_steps_and_stops_one_before_its_beginning() {
        let film = Film {
            turntable: Some(4),
            times: false,
            between: 0,
            keyframes: None,
        };
        let mut scene = SceneFlags::default();
        scene.camera.elevation = Some(0.0);
        let shots = shots(&film, &scene, 1).expect("a film");
        let directions: Vec<_> = shots
            .iter()
            .map(|shot| (shot.camera.eye - shot.camera.target).normalize())
            .collect();
        for (k, wanted) in [
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [-1.0, 0.0, 0.0],
            [0.0, -1.0, 0.0],
        ]
        .into_iter()
        .enumerate()
        {
            let off = (directions[k] - glam::DVec3::from(wanted)).length();
            assert!(off < 1e-15, "frame {k}: {:?}", directions[k]);
        }
    }

    #[test]
    fn a_turn_seen_along_its_axis_turns_the_picture() {
        for flags in [r#"{"view":"superior"}"#, r#"{"eye":"2,2,99"}"#] {
            let film = Film {
                turntable: Some(4),
                times: false,
                between: 0,
                keyframes: None,
            };
            let scene = SceneFlags {
                camera: serde_json::from_str(flags).expect("flags"),
                ..SceneFlags::default()
            };
            let shots = shots(&film, &scene, 1).expect("a film");
            let up = shots[1].camera.frame().up;
            assert!((up - -glam::DVec3::X).length() < 1e-14, "{flags}: {up}");
        }
    }

    #[test]
    fn a_film_of_nothing_and_one_too_long_are_refused() {
        let nothing = Film {
            times: false,
            between: 0,
            ..TIMES
        };
        for (film, times, code) in [
            (&nothing, 5, 2),
            (&TIMES, 1, 2),
            (&TIMES, MAX_FRAMES + 1, 6),
        ] {
            let error = shots(film, &SceneFlags::default(), times);
            assert_eq!(error.expect_err("refused").exit_code(), code);
        }
    }
}
