//! Which surfaces share a direction, a line, a centre, an offset, a radius, an angle.

/// Which thing of its kind every surface has; surfaces of one number share it.
#[derive(Debug, Clone)]
pub struct Classes {
    /// Directions: normals and axes.
    pub direction: Vec<usize>,
    /// Axis lines.
    pub line: Vec<usize>,
    /// Centres of spheres and tori.
    pub center: Vec<usize>,
    /// Offsets of planes.
    pub offset: Vec<usize>,
    /// Radii of cylinders and spheres, minor radii of tori.
    pub radius: Vec<usize>,
    /// Half angles of cones.
    pub angle: Vec<usize>,
}

impl Classes {
    /// Every surface on its own.
    pub fn apart(count: usize) -> Self {
        let own: Vec<usize> = (0..count).collect();
        Self {
            direction: own.clone(),
            line: own.clone(),
            center: own.clone(),
            offset: own.clone(),
            radius: own.clone(),
            angle: own,
        }
    }
}

/// Takes a surface out of what a stage put it in.
pub fn evict(classes: &mut Classes, old: &Classes, surface: usize) {
    fn apart(new: &mut [usize], old: &[usize], surface: usize) {
        if new[surface] == old[surface] && new.iter().filter(|c| **c == new[surface]).count() < 2 {
            return;
        }
        let left = new[surface];
        let rest: Vec<usize> = (0..new.len()).filter(|&i| i != surface && new[i] == left).collect();
        // The class is called after its first surface.
        rest.iter().for_each(|&i| new[i] = rest[0]);
        new[surface] = surface;
    }
    for (new, old) in [
        (&mut classes.line, &old.line),
        (&mut classes.center, &old.center),
        (&mut classes.offset, &old.offset),
        (&mut classes.radius, &old.radius),
        (&mut classes.angle, &old.angle),
    ] {
        if new != old {
            apart(new, old, surface);
        }
    }
}
