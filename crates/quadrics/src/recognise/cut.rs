//! Least cuts: Dinic's maximum flow on small graphs (Dinic 1970).

/// A flow network between a source and a sink, built anew for every cut.
#[derive(Default)]
pub struct Cut {
    /// First arc of every node.
    heads: Vec<u32>,
    /// Every arc is followed by its reverse.
    arcs: Vec<Arc>,
    level: Vec<u32>,
    cursor: Vec<u32>,
}

/// What flows between two nodes.
struct Arc {
    to: u32,
    /// The next arc of the node that it comes from.
    next: u32,
    capacity: f64,
}

const NONE: u32 = u32::MAX;
const SOURCE: u32 = 0;
const SINK: u32 = 1;
/// Flows below it are rounding.
const LEAST: f64 = 1e-9;

impl Cut {
    /// A network of `nodes` nodes and no arcs.
    pub fn new(nodes: usize) -> Self {
        Self { heads: vec![NONE; nodes + 2], ..Self::default() }
    }

    /// What it costs when `node` ends on the sink's side, and on the source's.
    pub fn node(&mut self, node: usize, at_sink: f64, at_source: f64) {
        let node = node as u32 + 2;
        if at_sink > at_source {
            self.arc(SOURCE, node, at_sink - at_source, 0.0);
        } else if at_source > at_sink {
            self.arc(node, SINK, at_source - at_sink, 0.0);
        }
    }

    /// What it costs when `one` ends at the source and `other` at the sink, and the reverse.
    pub fn edge(&mut self, one: usize, other: usize, forth: f64, back: f64) {
        self.arc(one as u32 + 2, other as u32 + 2, forth, back);
    }

    fn arc(&mut self, from: u32, to: u32, forth: f64, back: f64) {
        for (from, to, capacity) in [(from, to, forth), (to, from, back)] {
            let next = self.heads[from as usize];
            self.heads[from as usize] = self.arcs.len() as u32;
            self.arcs.push(Arc { to, next, capacity });
        }
    }

    /// Cuts; whether each node is on the sink's side.
    pub fn solve(mut self) -> Vec<bool> {
        while self.levels() {
            self.cursor.clone_from(&self.heads);
            self.augment();
        }
        self.level[2..].iter().map(|&level| level == NONE).collect()
    }

    /// Breadth-first levels from the source, up to the sink; whether it is reached.
    fn levels(&mut self) -> bool {
        self.level.clear();
        self.level.resize(self.heads.len(), NONE);
        self.level[SOURCE as usize] = 0;
        let mut queue = vec![SOURCE];
        let mut at = 0;
        while at < queue.len() && self.level[SINK as usize] == NONE {
            let node = queue[at];
            at += 1;
            let mut next = self.heads[node as usize];
            while next != NONE {
                let arc = &self.arcs[next as usize];
                if arc.capacity > LEAST && self.level[arc.to as usize] == NONE {
                    self.level[arc.to as usize] = self.level[node as usize] + 1;
                    queue.push(arc.to);
                }
                next = arc.next;
            }
        }
        self.level[SINK as usize] != NONE
    }

    /// Pushes flow along paths of rising levels until none is left, depth first without recursion.
    fn augment(&mut self) {
        let mut path: Vec<u32> = Vec::new();
        let mut node = SOURCE;
        loop {
            if node == SINK {
                let full = self.push(&path);
                node = self.arcs[path[full] as usize ^ 1].to;
                path.truncate(full);
                continue;
            }
            let next = self.cursor[node as usize];
            if next == NONE {
                // A dead end: step back and never come here again.
                let Some(last) = path.pop() else { return };
                node = self.arcs[last as usize ^ 1].to;
                self.cursor[node as usize] = self.arcs[last as usize].next;
                continue;
            }
            let arc = &self.arcs[next as usize];
            let rises = self.level[arc.to as usize] == self.level[node as usize].wrapping_add(1);
            if rises && arc.capacity > LEAST {
                path.push(next);
                node = arc.to;
            } else {
                self.cursor[node as usize] = arc.next;
            }
        }
    }

    /// Pushes what a path lets through; the place of the first arc that it fills.
    fn push(&mut self, path: &[u32]) -> usize {
        let capacity = |&arc: &u32| self.arcs[arc as usize].capacity;
        let flow = path.iter().map(capacity).fold(f64::INFINITY, f64::min);
        for &arc in path {
            self.arcs[arc as usize].capacity -= flow;
            self.arcs[arc as usize ^ 1].capacity += flow;
        }
        let full = path.iter().position(|&arc| self.arcs[arc as usize].capacity <= LEAST);
        full.unwrap_or(0)
    }
}

#[cfg(test)]
mod tests {
    use rand::RngExt;

    use super::*;
    use crate::context::Context;

    #[test]
    fn the_cut_is_the_best_of_all_labellings() {
        let mut rng = Context::new(1).rng;
        for _ in 0..200 {
            let nodes = 7;
            let costs: Vec<[f64; 2]> = (0..nodes)
                .map(|_| [rng.random_range(0.0..3.0), rng.random_range(0.0..3.0)])
                .collect();
            let edges: Vec<(usize, usize, f64, f64)> = (0..12)
                .map(|_| {
                    let a = rng.random_range(0..nodes);
                    let b = (a + rng.random_range(1..nodes)) % nodes;
                    (a, b, rng.random_range(0.0..2.0), rng.random_range(0.0..2.0))
                })
                .collect();
            let energy = |sink: &dyn Fn(usize) -> bool| {
                let unary: f64 = (0..nodes).map(|i| costs[i][usize::from(!sink(i))]).sum();
                let pairs = edges.iter().map(|&(a, b, forth, back)| match (sink(a), sink(b)) {
                    (false, true) => forth,
                    (true, false) => back,
                    _ => 0.0,
                });
                unary + pairs.sum::<f64>()
            };
            let mut cut = Cut::new(nodes);
            costs.iter().enumerate().for_each(|(i, c)| cut.node(i, c[0], c[1]));
            edges.iter().for_each(|&(a, b, forth, back)| cut.edge(a, b, forth, back));
            let sides = cut.solve();
            let best = (0..1 << nodes)
                .map(|mask| energy(&|i| mask >> i & 1 == 1))
                .fold(f64::MAX, f64::min);
            assert!((energy(&|i| sides[i]) - best).abs() < 1e-6);
        }
    }
}
