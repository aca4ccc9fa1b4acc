//! `preset="default"`: the surfaces of a part, whatever its noise, with nothing to tune.

pub mod detect;
pub mod evidence;
pub mod scene;

use crate::context::Context;
use crate::error::Result;
use crate::mesh::Mesh;
use crate::options::Options;
use crate::partition::{Labels, UNLABELLED};
use crate::surface::Surface;
use crate::surface::select::Evidence;
use scene::Scene;

/// Labels of all faces, and a surface for every label.
pub struct Outcome {
    /// Region of every face.
    pub labels: Labels,
    /// Surface of every region, in the frame of the mesh.
    pub surfaces: Vec<Surface>,
    /// Noise, in the unit of the mesh.
    pub evidence: Evidence,
    /// Standard deviation of the filtered normals, in radians.
    pub normal_sigma: f64,
}

/// Recognises the surfaces of a mesh that lies in the unit cube.
///
/// # Errors
/// Cancellation.
pub fn recognise(
    context: &mut Context,
    mesh: &Mesh,
    _options: &Options,
    _initial_labels: Option<&[u32]>,
) -> Result<Outcome> {
    let mut scene = context.timed("prepare", |_| Ok(Scene::new(mesh)))?;
    context.timed("noise", |context| evidence::measure(context, &mut scene))?;
    let mut labels = vec![UNLABELLED; mesh.faces.len()];
    let found = context.timed("detect", |context| detect::detect(context, &scene, &mut labels))?;
    let surfaces = found.into_iter().map(|c| c.choice.surface).collect();
    Ok(Outcome { labels, surfaces, evidence: scene.evidence, normal_sigma: scene.normal_sigma })
}
