//! winit's part: a window, its events, and when a frame is due.

use crate::error::Error;
use crate::script::{self, Step};
use crate::subject::Subject;
use crate::view::View;
use crate::window::Window;
use crate::words::Arguments;
use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;
use winit::application::ApplicationHandler;
use winit::dpi::PhysicalSize;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop, EventLoopProxy};
use winit::window::WindowId;

/// Opens the volume, then a window, and stays until that is closed.
pub fn run(words: Arguments) -> Result<(), Error> {
    let steps = match (&words.script, &words.screenshot) {
        (Some(path), _) => Some(script::read(path)?),
        (None, Some(path)) => Some([Step::Frame, Step::Frame, Step::Window(path.clone())].into()),
        (None, None) => None,
    };
    if let Some(marks) = &words.annotate {
        marks
            .check()
            .map_err(|error| Error::Arguments(error.to_string()))?;
    }
    let subject = Subject::open(&words)?;
    let view = View::new(subject, !words.bare, words.annotate.as_ref());
    if let (true, Some(note)) = (view.has_marks, view.annotation.note()) {
        println!("{note}");
    }
    let no_display = |cause| Error::Window(format!("no display to open a window on: {cause}"));
    let events = EventLoop::new().map_err(no_display)?;
    let mut app = App {
        proxy: events.create_proxy(),
        view: Some(view),
        steps,
        words,
        window: None,
        messages: Arc::default(),
        due: None,
        ended: Ok(()),
    };
    events.run_app(&mut app).map_err(no_display)?;
    // What destroying has to say is heard too.
    app.window = None;
    app.ended?;
    match app.messages.load(Ordering::Relaxed) {
        0 => Ok(()),
        count => Err(Error::Validation(count)),
    }
}

struct App {
    words: Arguments,
    proxy: EventLoopProxy<()>,
    /// Until there is a window.
    view: Option<View>,
    steps: Option<VecDeque<Step>>,
    window: Option<Window>,
    messages: Arc<AtomicUsize>,
    /// When the next frame is, where egui wants one by itself.
    due: Option<Instant>,
    ended: Result<(), Error>,
}

impl App {
    fn open(&mut self, events: &ActiveEventLoop) -> Result<(), Error> {
        let Some(view) = self.view.take() else {
            return Ok(());
        };
        let [width, height] = self.words.size;
        let attributes = winit::window::Window::default_attributes()
            .with_title(view.title())
            .with_inner_size(PhysicalSize::new(width, height))
            .with_min_inner_size(PhysicalSize::new(64, 64));
        let window = events
            .create_window(attributes)
            .map_err(|cause| Error::Window(format!("no window can be opened: {cause}")))?;
        let proxy = std::sync::Mutex::new(self.proxy.clone());
        let wake = move || {
            // The loop has ended: nobody waits.
            if let Ok(proxy) = proxy.lock() {
                let _ = proxy.send_event(());
            }
        };
        let steps = self.steps.take();
        let made = Window::new(window, &self.words, view, steps, Arc::new(wake))?;
        self.messages = made.messages();
        self.window = Some(made);
        Ok(())
    }

    /// Ends the loop, with what went wrong if anything did.
    fn end(&mut self, events: &ActiveEventLoop, ended: Result<(), Error>) {
        if self.ended.is_ok() {
            self.ended = ended;
        }
        events.exit();
    }

    fn frame(&mut self, events: &ActiveEventLoop) {
        let Some(window) = &mut self.window else {
            return;
        };
        match window.frame() {
            Ok(next) => {
                self.due = next.at;
                if next.ends {
                    self.end(events, Ok(()));
                }
            }
            Err(error) => self.end(events, Err(error)),
        }
    }
}

impl ApplicationHandler<()> for App {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        if let Err(error) = self.open(events) {
            self.end(events, Err(error));
        }
    }

    fn user_event(&mut self, _: &ActiveEventLoop, (): ()) {
        if let Some(window) = &self.window {
            window.ask_for_frame();
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        match event {
            WindowEvent::CloseRequested => self.end(events, Ok(())),
            // Nobody has asked: another program has done it.
            WindowEvent::Destroyed => self.end(events, Err(Error::SurfaceLost)),
            WindowEvent::RedrawRequested => self.frame(events),
            event => {
                if let Some(window) = &mut self.window {
                    window.hear(&event);
                }
            }
        }
    }

    fn about_to_wait(&mut self, events: &ActiveEventLoop) {
        match self.due {
            Some(at) if at <= Instant::now() => {
                self.due = None;
                if let Some(window) = &self.window {
                    window.ask_for_frame();
                }
                events.set_control_flow(ControlFlow::Wait);
            }
            Some(at) => events.set_control_flow(ControlFlow::WaitUntil(at)),
            None => events.set_control_flow(ControlFlow::Wait),
        }
    }
}
