//! Draws a mesh without a display: a z-buffer, so that pictures need no library and no screen.
//!
//! Orthographic, one light at the eye. Where the label changes between two pixels a dark line is
//! drawn. The pixels depend on the input alone, not on the number of threads.

use rayon::prelude::*;

use crate::math::{Point, Unit, Vector};
use crate::mesh::Mesh;

/// From where a mesh is seen, and how large.
#[derive(Debug, Clone, PartialEq)]
pub struct View {
    /// From the mesh to the eye; any length.
    pub toward_eye: Vector,
    /// Pixels across.
    pub width: usize,
    /// Pixels down.
    pub height: usize,
}

/// Behind everything.
const BACKGROUND: [u8; 3] = [255, 255, 255];
/// Between regions, and around the part.
const LINE: [f64; 3] = [30.0, 30.0, 35.0];
/// Samples a pixel has along each side: lines and outlines come out smooth.
pub const SAMPLES: usize = 2;
/// Share of the picture that the part fills.
const FILL: f64 = 0.92;
/// Rows of samples that one task draws: a fixed number, so that tasks never differ in their work.
const BAND: usize = 64;
/// No face.
pub const NOTHING: u32 = u32::MAX;

/// What is seen of a mesh: samples row by row, `SAMPLES` times as many as pixels along each side.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Seen {
    /// The faces that are seen, ascending.
    pub faces: Vec<u32>,
    /// For every sample the place in `faces` of the nearest face, or [`NOTHING`].
    pub samples: Vec<u32>,
}

/// Which face is seen at every sample of the picture.
pub fn see(mesh: &Mesh, view: &View) -> Seen {
    let (width, height) = (view.width * SAMPLES, view.height * SAMPLES);
    let camera = Camera::new(mesh, view, width, height);
    let screen: Vec<Vector> = mesh.positions.par_iter().map(|p| camera.screen(p)).collect();
    let mut samples = vec![NOTHING; width * height];
    let bands = bands(mesh, &screen, height);
    samples.par_chunks_mut(BAND * width).zip(&bands).enumerate().for_each(
        |(band, (rows, faces))| draw_band(mesh, &screen, faces, rows, width, band * BAND),
    );
    let mut place = vec![NOTHING; mesh.faces.len()];
    samples.iter().filter(|&&face| face != NOTHING).for_each(|&face| place[face as usize] = 0);
    let faces: Vec<u32> = (0..place.len() as u32).filter(|&f| place[f as usize] == 0).collect();
    faces.iter().zip(0..).for_each(|(&face, i)| place[face as usize] = i);
    let named = samples.iter_mut().filter(|sample| **sample != NOTHING);
    named.for_each(|sample| *sample = place[*sample as usize]);
    Seen { faces, samples }
}

/// The pixels, row by row: one colour, shading normal and label for each of the faces that are seen.
///
/// # Panics
/// If there are fewer samples than the view asks for, or fewer colours, normals or labels than faces.
pub fn paint(
    samples: &[u32],
    colours: &[[u8; 3]],
    normals: &[Vector],
    labels: &[i32],
    view: &View,
) -> Vec<[u8; 3]> {
    let (width, height) = (view.width * SAMPLES, view.height * SAMPLES);
    assert!(samples.len() >= width * height);
    let light = Light::new(view);
    let lit: Vec<[f64; 3]> =
        normals.par_iter().zip(colours).map(|(normal, colour)| light.on(normal, *colour)).collect();
    let label = |face: u32| if face == NOTHING { i32::MIN } else { labels[face as usize] };
    let shade = |sample: usize| {
        let (x, y) = (sample % width, sample / width);
        let right = sample + usize::from(x + 1 < width);
        let below = sample + if y + 1 < height { width } else { 0 };
        let face = samples[sample];
        let border =
            |&other: &usize| samples[other] != face && label(samples[other]) != label(face);
        if [right, below].iter().any(border) {
            return LINE;
        }
        if face == NOTHING { BACKGROUND.map(f64::from) } else { lit[face as usize] }
    };
    let pixel = |index: usize| average(index % view.width, index / view.width, width, shade);
    (0..view.width * view.height).into_par_iter().map(pixel).collect()
}

/// First and last row of samples that a face may cover; first after last where it covers none.
fn rows_of(screen: &[Vector], corners: &[u32; 3]) -> (f64, f64) {
    let [a, b, c] = corners.map(|v| screen[v as usize].y);
    (a.min(b).min(c).ceil(), a.max(b).max(c).floor())
}

/// The faces that each band of rows has to draw, ascending.
fn bands(mesh: &Mesh, screen: &[Vector], height: usize) -> Vec<Vec<u32>> {
    let mut bands = vec![Vec::new(); height.div_ceil(BAND)];
    for (face, corners) in mesh.faces.iter().enumerate() {
        let (first, last) = rows_of(screen, corners);
        if first <= last && last >= 0.0 && first < height as f64 {
            let last = (last as usize).min(height - 1);
            for band in &mut bands[first.max(0.0) as usize / BAND..=last / BAND] {
                band.push(face as u32);
            }
        }
    }
    bands
}

/// Fills the nearest face of every sample in rows `first ..`.
fn draw_band(
    mesh: &Mesh,
    screen: &[Vector],
    faces: &[u32],
    rows: &mut [u32],
    width: usize,
    first: usize,
) {
    let last = first + rows.len() / width;
    let mut depth = vec![f64::NEG_INFINITY; rows.len()];
    for &face in faces {
        let corners = mesh.faces[face as usize];
        let [a, b, c] = corners.map(|v| screen[v as usize]);
        let (top, bottom) = rows_of(screen, &corners);
        let (top, bottom) = (top.max(first as f64), (bottom + 1.0).min(last as f64));
        let left = a.x.min(b.x).min(c.x).ceil().max(0.0);
        let right = (a.x.max(b.x).max(c.x).floor() + 1.0).min(width as f64);
        let double_area = (b - a).xy().perp(&(c - a).xy());
        if double_area == 0.0 || top >= bottom || left >= right {
            continue;
        }
        let (across, along) = ((b - a).xy() / double_area, (c - a).xy() / double_area);
        for y in top as usize..bottom as usize {
            for x in left as usize..right as usize {
                let offset = Vector::new(x as f64, y as f64, 0.0) - a;
                let (u, v) = (offset.xy().perp(&along), across.perp(&offset.xy()));
                if u < 0.0 || v < 0.0 || u + v > 1.0 {
                    continue;
                }
                let z = a.z + u * (b.z - a.z) + v * (c.z - a.z);
                let sample = (y - first) * width + x;
                // Ties go to the lower face index.
                if z > depth[sample] {
                    depth[sample] = z;
                    rows[sample] = face;
                }
            }
        }
    }
}

/// Mean colour of the samples of pixel `(x, y)`.
fn average(x: usize, y: usize, width: usize, shade: impl Fn(usize) -> [f64; 3]) -> [u8; 3] {
    let mut sum = [0.0; 3];
    for row in 0..SAMPLES {
        for column in 0..SAMPLES {
            let colour = shade((y * SAMPLES + row) * width + x * SAMPLES + column);
            sum.iter_mut().zip(colour).for_each(|(total, value)| *total += value);
        }
    }
    sum.map(|total| (total / (SAMPLES * SAMPLES) as f64).round() as u8)
}

/// The directions of the picture, and its light at the eye.
#[derive(Clone, Copy)]
struct Light {
    right: Vector,
    down: Vector,
    eye: Vector,
}

impl Light {
    fn new(view: &View) -> Self {
        let eye = Unit::try_new(view.toward_eye, 0.0).unwrap_or_else(Vector::z_axis).into_inner();
        // Up on the picture is z; seen from above, it is y.
        let up = if eye.xy().norm() > 1e-6 { Vector::z() } else { Vector::y() };
        let right = up.cross(&eye).normalize();
        Self { right, down: right.cross(&eye), eye }
    }

    /// Colour of a face; both sides are lit, scans are often open.
    fn on(&self, normal: &Vector, colour: [u8; 3]) -> [f64; 3] {
        let sideways = normal.dot(&(self.down * -0.35 + self.right * -0.25)).max(-0.3);
        let brightness = (0.42 + 0.58 * normal.dot(&self.eye).abs() + 0.25 * sideways).min(1.0);
        colour.map(|channel| f64::from(channel) * brightness)
    }
}

/// Where points fall on the picture: `z` grows toward the eye.
struct Camera {
    axes: Light,
    scale: f64,
    shift: Vector,
}

impl Camera {
    fn new(mesh: &Mesh, view: &View, width: usize, height: usize) -> Self {
        let mut camera = Self { axes: Light::new(view), scale: 1.0, shift: Vector::zeros() };
        let used = mesh.faces.iter().flatten().map(|&v| camera.screen(&mesh.positions[v as usize]));
        let (low, high) = used.fold(
            (Vector::repeat(f64::INFINITY), Vector::repeat(f64::NEG_INFINITY)),
            |(low, high), p| (low.inf(&p), high.sup(&p)),
        );
        if low.x <= high.x {
            let size = (high - low).map(|side| side.max(f64::MIN_POSITIVE));
            camera.scale = FILL * (width as f64 / size.x).min(height as f64 / size.y);
            let middle = Vector::new(width as f64 / 2.0, height as f64 / 2.0, 0.0);
            camera.shift = middle - (low + high) / 2.0 * camera.scale;
        }
        camera
    }

    fn screen(&self, point: &Point) -> Vector {
        let p = &point.coords;
        let Light { right, down, eye } = self.axes;
        let flat = Vector::new(right.dot(p), down.dot(p), eye.dot(p));
        flat * self.scale + self.shift
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(z: f64) -> [Point; 4] {
        [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| Point::new(x, y, z))
    }

    fn draw(mesh: &Mesh, colours: &[[u8; 3]], toward_eye: Vector) -> Vec<[u8; 3]> {
        let view = View { toward_eye, width: 40, height: 40 };
        let Seen { faces, samples } = see(mesh, &view);
        let colours: Vec<_> = faces.iter().map(|&face| colours[face as usize]).collect();
        let normals = vec![Vector::z(); faces.len()];
        paint(&samples, &colours, &normals, &vec![0; faces.len()], &view)
    }

    #[test]
    fn the_nearer_square_hides_the_farther_one_from_either_side() {
        let positions = square(0.0).into_iter().chain(square(1.0)).collect();
        let faces = vec![[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]];
        let mesh = Mesh { positions, faces };
        let colours = [[200, 0, 0], [200, 0, 0], [0, 200, 0], [0, 200, 0]];
        let middle = 20 * 40 + 20;
        let above = draw(&mesh, &colours, Vector::z())[middle];
        let below = draw(&mesh, &colours, -Vector::z())[middle];
        assert!(above[1] > 100 && above[0] == 0, "{above:?}");
        assert!(below[0] > 100 && below[1] == 0, "{below:?}");
    }

    #[test]
    fn an_empty_mesh_gives_an_empty_picture() {
        let pixels = draw(&Mesh::default(), &[], Vector::x());
        assert!(pixels.iter().all(|&pixel| pixel == BACKGROUND));
    }
}
