//! Another renderer as a program beside this one: an azimuth goes in, milliseconds and a picture come out.

use std::io::{BufRead, BufReader, Read, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use crate::errors::Grey;

const VOLPACK: &str = include_str!("volpack.c");
const CASTER: &str = include_str!("caster.py");
/// Ends well where the package is there, and a window that needs no display too.
const WINDOW: &str = r#"
import os
os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkOSOpenGLRenderWindow")
import numpy, vtk
window = vtk.vtkRenderWindow()
window.SetOffScreenRendering(1)
window.Render()
"#;

/// A running program that answers with pictures.
pub struct Program {
    child: Child,
    asks: ChildStdin,
    answers: BufReader<ChildStdout>,
    width: usize,
}

impl Program {
    /// Starts a program whose pictures are `width` pixels wide and high.
    fn start(command: &mut Command, width: usize) -> Result<Self, String> {
        let piped = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn();
        let mut child = piped.map_err(|e| format!("{command:?} does not start: {e}"))?;
        let (asks, answers) = child.stdin.take().zip(child.stdout.take()).ok_or("no pipes")?;
        Ok(Self { child, asks, answers: BufReader::new(answers), width })
    }

    /// Milliseconds of the frame from an azimuth in degrees, and its luminance.
    pub fn frame(&mut self, azimuth: f64) -> Result<(f64, Grey), String> {
        let failed = |e: std::io::Error| format!("a peer stopped answering: {e}");
        writeln!(self.asks, "{azimuth}").and_then(|()| self.asks.flush()).map_err(failed)?;
        let mut line = String::new();
        self.answers.read_line(&mut line).map_err(failed)?;
        let told = line.split_once(' ').and_then(|(milliseconds, channels)| {
            Some((milliseconds.parse().ok()?, channels.trim().parse().ok()?))
        });
        let (milliseconds, channels): (f64, usize) =
            told.ok_or_else(|| format!("a peer answered {line:?}, not its milliseconds"))?;
        let mut bytes = vec![0; self.width * self.width * channels];
        self.answers.read_exact(&mut bytes).map_err(failed)?;
        let linear = |pixel: &[u8]| match pixel {
            [r, g, b] => Grey::luminance([*r, *g, *b].map(|c| f32::from(c) / 255.0)),
            grey => f32::from(grey[0]) / 255.0,
        };
        let pixels = bytes.chunks_exact(channels).map(linear).collect();
        Ok((milliseconds, Grey { width: self.width, pixels }))
    }
}

impl Drop for Program {
    fn drop(&mut self) {
        // It has nothing left to answer.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// What a peer is told of the task.
pub struct Told<'a> {
    /// A folder for what is compiled and written.
    pub folder: &'a Path,
    /// The file of voxels.
    pub voxels: &'a str,
    /// Voxels on each axis.
    pub size: [usize; 3],
    /// Between slices, in spacings within a slice.
    pub z_spacing: f64,
    /// Pixels across.
    pub width: usize,
    /// Degrees.
    pub elevation: f64,
}

impl Told<'_> {
    fn arguments(&self) -> Vec<String> {
        let [nx, ny, nz] = self.size;
        let Self { z_spacing, width, elevation, voxels, .. } = self;
        let numbers = [nx.to_string(), ny.to_string(), nz.to_string(), z_spacing.to_string()];
        let view = [width.to_string(), elevation.to_string()];
        [vec![(*voxels).to_owned()], numbers.to_vec(), view.to_vec()].concat()
    }

    /// VolPack, compiled here; the error says what is missing and how it is installed.
    pub fn volpack(&self) -> Result<Program, String> {
        let (source, program) = (self.folder.join("volpack.c"), self.folder.join("volpack"));
        std::fs::write(&source, VOLPACK).map_err(|e| e.to_string())?;
        let mut compile = Command::new("cc");
        compile.args(["-O2", "-o"]).arg(&program).arg(&source).args(["-lvolpack", "-lm"]);
        let compiled = compile.output().is_ok_and(|output| output.status.success());
        if !compiled {
            return Err(
                "`cc … -lvolpack` fails; install a C compiler and Debian's libvolpack1-dev"
                    .to_owned(),
            );
        }
        // What is fainter than a byte's half step is clear, and a ray stops where gelray's does.
        let mut run = Command::new(program);
        run.current_dir(self.folder).args(self.arguments()).args(["0.002", "0.98"]);
        Program::start(&mut run, self.width)
    }

    /// VTK's fixed-point caster, with so many pixels between rays; the error says how it is installed.
    pub fn vtk(&self, kind: &str, between: f64) -> Result<Program, String> {
        let there = Command::new("python3").args(["-c", WINDOW]).output();
        if !there.is_ok_and(|output| output.status.success()) {
            return Err("VTK shows no window; `pip install vtk numpy`, and Debian's libosmesa6 where there is no display".to_owned());
        }
        let mut run = Command::new("python3");
        run.current_dir(self.folder).args(["-c", CASTER, kind]);
        run.args(self.arguments()).arg(between.to_string()).stderr(Stdio::null());
        Program::start(&mut run, self.width)
    }
}
