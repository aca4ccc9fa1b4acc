//! Faces that hang together, and which of them are wound against the first: sets that are joined, as
//! trees whose links know whether their two ends agree (Galler and Fischer, CACM 1964).

/// Trees of faces; the first face of a tree is its root.
#[derive(Debug)]
pub(super) struct Windings {
    /// Twice the number of a face that comes no later, plus one if it is wound the other way.
    links: Vec<u32>,
}

impl Windings {
    /// Every face by itself.
    pub fn new(faces: usize) -> Self {
        Self { links: (0..faces as u32).map(|face| 2 * face).collect() }
    }

    /// Joins the trees of two neighbours; whether both can be wound as they demand.
    pub fn join(&mut self, one: u32, other: u32, agree: bool) -> bool {
        let (one, other) = (self.root(one), self.root(other));
        let against = (one ^ other) & 1 ^ u32::from(!agree);
        let (low, high) = (one.min(other), one.max(other));
        if one / 2 == other / 2 {
            return against == 0;
        }
        self.links[high as usize / 2] = low & !1 | against;
        true
    }

    /// The component of every face, numbered by their first faces, and whether it must be turned to
    /// agree with that.
    pub fn components(mut self) -> (Vec<u32>, Vec<bool>, usize) {
        let mut count = 0;
        let mut flip = vec![false; self.links.len()];
        for face in 0..self.links.len() {
            let link = self.links[face];
            let above = link as usize / 2;
            if above == face {
                self.links[face] = count;
                count += 1;
            } else {
                // What comes before is known already.
                self.links[face] = self.links[above];
                flip[face] = flip[above] != (link & 1 == 1);
            }
        }
        (self.links, flip, count as usize)
    }

    /// A link from a face to the root of its tree; halves the way there.
    fn root(&mut self, face: u32) -> u32 {
        let mut link = 2 * face;
        loop {
            let here = link as usize / 2;
            let up = self.links[here];
            let above = self.links[up as usize / 2];
            if above / 2 == up / 2 {
                return up ^ link & 1;
            }
            self.links[here] = above ^ up & 1;
            link = self.links[here] ^ link & 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_face_is_wound_as_the_links_to_the_first_one_say() {
        let mut windings = Windings::new(6);
        assert!(
            windings.join(4, 5, false) && windings.join(2, 4, true) && windings.join(5, 1, false)
        );
        assert!(windings.join(3, 0, false));
        assert!(windings.join(1, 2, true), "1 agrees with 4 and so with 2");
        assert!(!windings.join(5, 2, true), "5 does not");
        let (component, flip, count) = windings.components();
        assert_eq!((component, count), (vec![0, 1, 1, 0, 1, 1], 2));
        assert_eq!(flip, [false, false, false, true, false, true]);
    }
}
