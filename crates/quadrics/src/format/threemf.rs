//! 3MF: a zip of XML models, built of objects that are meshes or are put together from other objects.
//!
//! The build says which objects there are in the end and where; each is followed down to its meshes,
//! and the transforms on the way are multiplied. The unit that the model names goes into the result.

mod model;
mod package;

use std::collections::BTreeMap;

use nalgebra::{Matrix4, Point3};

use super::build::Builder;
use super::{Loaded, error};
use crate::error::{Error, Result};
use model::{Instance, Model, Object};
use package::Package;

/// Instances that are followed: objects made of objects made of objects grow exponentially.
const MOST_INSTANCES: usize = 100_000;

pub(super) fn read(bytes: &[u8]) -> Result<Loaded> {
    let mut package = Package::open(bytes)?;
    let root = package.root()?;
    let mut models = BTreeMap::from([(root.clone(), package.model(&root)?)]);
    let items = start(&models[&root], &root);
    let found = follow(items, &root, &mut models, &mut package)?;
    let triangles = models.values().flat_map(|model| model.objects.values());
    let triangles: usize =
        triangles.map(|object| object.faces.len() + object.positions.len()).sum();
    let mut builder = Builder::new("3MF", 0, 0);
    builder.limit_copies(triangles);
    for (path, id, matrix) in &found {
        add(&models[path].objects[id], matrix, &mut builder)?;
    }
    let mut loaded = builder.finish()?;
    loaded.units = Some(models[&root].unit.clone());
    Ok(loaded)
}

/// What is built; without a build, every object that is a mesh.
fn start(model: &Model, path: &str) -> Vec<Instance> {
    if !model.items.is_empty() {
        return model.items.clone();
    }
    let meshes = model.objects.iter().filter(|(_, object)| !object.faces.is_empty());
    let instance = |(id, _): (&String, _)| Instance {
        path: Some(path.into()),
        id: id.clone(),
        matrix: Matrix4::identity(),
    };
    meshes.map(instance).collect()
}

/// The objects that are meshes, with the product of the transforms above each, in the order of the file.
fn follow(
    items: Vec<Instance>,
    root: &str,
    models: &mut BTreeMap<String, Model>,
    package: &mut Package,
) -> Result<Vec<(String, String, Matrix4<f64>)>> {
    let place = |instance: &Instance, path: &str, above: &Matrix4<f64>| {
        let path = instance.path.clone().unwrap_or_else(|| path.into());
        (path, instance.id.clone(), above * instance.matrix)
    };
    let identity = Matrix4::identity();
    let mut stack: Vec<_> = items.iter().rev().map(|item| place(item, root, &identity)).collect();
    let mut found = Vec::new();
    let mut instances = 0;
    while let Some((path, id, matrix)) = stack.pop() {
        instances += 1;
        // The stack is counted, too: one object may name ten thousand others, and each of them as many.
        if instances + stack.len() > MOST_INSTANCES {
            let what = format!("more than {MOST_INSTANCES} objects; are they made of each other?");
            return Err(error("3MF", what));
        }
        if !models.contains_key(&path) {
            let model = package.model(&path)?;
            models.insert(path.clone(), model);
        }
        let Some(object) = models[&path].objects.get(&id) else {
            let id: String = id.escape_debug().take(40).collect();
            return Err(error("3MF", format!("object {id} is missing; was the file cut off?")));
        };
        let components = object.components.iter().rev();
        stack.extend(components.map(|component| place(component, &path, &matrix)));
        if !object.faces.is_empty() {
            found.push((path, id, matrix));
        }
    }
    Ok(found)
}

fn add(object: &Object, matrix: &Matrix4<f64>, builder: &mut Builder) -> Result<()> {
    let first = builder.positions.len();
    builder.check_limit(first + object.positions.len())?;
    for p in &object.positions {
        builder.vertex(matrix.transform_point(&Point3::from(*p)).into());
    }
    // A mirror turns the winding.
    let mirrored = matrix.fixed_view::<3, 3>(0, 0).determinant() < 0.0;
    for &[a, b, c] in &object.faces {
        let corners = if mirrored { [a, c, b] } else { [a, b, c] };
        if let Some(&vertex) = corners.iter().find(|&&v| v as usize >= object.positions.len()) {
            return Err(Error::IndexOutOfRange {
                face: builder.count(),
                vertex: i64::from(vertex),
                vertices: object.positions.len(),
            });
        }
        builder.polygon(&corners.map(|corner| corner + first as u32))?;
    }
    Ok(())
}
