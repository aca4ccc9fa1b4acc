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
const SAMPLES: usize = 2;
/// Share of the picture that the part fills.
const FILL: f64 = 0.92;
/// Rows of samples that one task draws: a fixed number, so that tasks never differ in their work.
const BAND: usize = 64;
/// No face.
const NOTHING: u32 = u32::MAX;

/// The pixels, row by row: one colour, shading normal and label a face.
pub fn render(
    mesh: &Mesh,
    colours: &[[u8; 3]],
    normals: &[Vector],
    labels: &[i32],
    view: &View,
) -> Vec<[u8; 3]> {
    let (width, height) = (view.width * SAMPLES, view.height * SAMPLES);
    let camera = Camera::new(mesh, view, width, height);
    let screen: Vec<Vector> = mesh.positions.par_iter().map(|p| camera.screen(p)).collect();
    let mut seen = vec![NOTHING; width * height];
    seen.par_chunks_mut(BAND * width)
        .enumerate()
        .for_each(|(band, rows)| draw_band(mesh, &screen, rows, width, band * BAND));
    let label = |sample: usize| match seen[sample] {
        NOTHING => i32::MIN,
        face => labels[face as usize],
    };
    let shade = |sample: usize| {
        let (x, y) = (sample % width, sample / width);
        let right = sample + usize::from(x + 1 < width);
        let below = sample + if y + 1 < height { width } else { 0 };
        if label(sample) != label(right) || label(sample) != label(below) {
            return LINE;
        }
        match seen[sample] {
            NOTHING => BACKGROUND.map(f64::from),
            face => camera.light(&normals[face as usize], colours[face as usize]),
        }
    };
    let pixel = |index: usize| average(index % view.width, index / view.width, width, shade);
    (0..view.width * view.height).into_par_iter().map(pixel).collect()
}

/// Fills the nearest face of every sample in rows `first ..`.
fn draw_band(mesh: &Mesh, screen: &[Vector], rows: &mut [u32], width: usize, first: usize) {
    let last = first + rows.len() / width;
    let mut depth = vec![f64::NEG_INFINITY; rows.len()];
    for (face, corners) in mesh.faces.iter().enumerate() {
        let [a, b, c] = corners.map(|v| screen[v as usize]);
        let top = a.y.min(b.y).min(c.y).ceil().max(first as f64);
        let bottom = (a.y.max(b.y).max(c.y).floor() + 1.0).min(last as f64);
        let left = a.x.min(b.x).min(c.x).ceil().max(0.0);
        let right = (a.x.max(b.x).max(c.x).floor() + 1.0).min(width as f64);
        let double_area = (b - a).xy().perp(&(c - a).xy());
        if double_area == 0.0 || top >= bottom || left >= right {
            continue;
        }
        for y in top as usize..bottom as usize {
            for x in left as usize..right as usize {
                let offset = Vector::new(x as f64, y as f64, 0.0) - a;
                let u = offset.xy().perp(&(c - a).xy()) / double_area;
                let v = (b - a).xy().perp(&offset.xy()) / double_area;
                if u < 0.0 || v < 0.0 || u + v > 1.0 {
                    continue;
                }
                let z = a.z + u * (b.z - a.z) + v * (c.z - a.z);
                let sample = (y - first) * width + x;
                // Ties go to the lower face index.
                if z > depth[sample] {
                    depth[sample] = z;
                    rows[sample] = face as u32;
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

/// Where points fall on the picture: `z` grows toward the eye.
struct Camera {
    right: Vector,
    down: Vector,
    eye: Vector,
    scale: f64,
    shift: Vector,
}

impl Camera {
    fn new(mesh: &Mesh, view: &View, width: usize, height: usize) -> Self {
        let eye = Unit::try_new(view.toward_eye, 0.0).unwrap_or_else(Vector::z_axis).into_inner();
        // Up on the picture is z; seen from above, it is y.
        let up = if eye.xy().norm() > 1e-6 { Vector::z() } else { Vector::y() };
        let right = up.cross(&eye).normalize();
        let down = right.cross(&eye);
        let mut camera = Self { right, down, eye, scale: 1.0, shift: Vector::zeros() };
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
        let flat = Vector::new(self.right.dot(p), self.down.dot(p), self.eye.dot(p));
        flat * self.scale + self.shift
    }

    /// Colour of a face under a light at the eye; both sides are lit, scans are often open.
    fn light(&self, normal: &Vector, colour: [u8; 3]) -> [f64; 3] {
        let sideways = normal.dot(&(self.down * -0.35 + self.right * -0.25)).max(-0.3);
        let brightness = (0.42 + 0.58 * normal.dot(&self.eye).abs() + 0.25 * sideways).min(1.0);
        colour.map(|channel| f64::from(channel) * brightness)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(z: f64) -> [Point; 4] {
        [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| Point::new(x, y, z))
    }

    fn draw(mesh: &Mesh, colours: &[[u8; 3]], toward_eye: Vector) -> Vec<[u8; 3]> {
        let normals = vec![Vector::z(); mesh.faces.len()];
        let labels = vec![0; mesh.faces.len()];
        render(mesh, colours, &normals, &labels, &View { toward_eye, width: 40, height: 40 })
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
