//! Least cuts: Dinic's maximum flow on small graphs (Dinic 1970).

/// A flow network between a source and a sink, built anew for every cut.
#[derive(Default)]
pub struct Cut {
    heads: Vec<u32>,
    next: Vec<u32>,
    to: Vec<u32>,
    capacity: Vec<f64>,
    level: Vec<u32>,
    cursor: Vec<u32>,
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
            self.next.push(self.heads[from as usize]);
            self.heads[from as usize] = self.to.len() as u32;
            self.to.push(to);
            self.capacity.push(capacity);
        }
    }

    /// Cuts; whether each node is on the sink's side.
    pub fn solve(mut self) -> Vec<bool> {
        while self.levels() {
            self.cursor.clone_from(&self.heads);
            while self.augment() > LEAST {}
        }
        self.level[2..].iter().map(|&level| level == NONE).collect()
    }

    /// Breadth-first levels from the source; whether the sink is reached.
    fn levels(&mut self) -> bool {
        self.level.clear();
        self.level.resize(self.heads.len(), NONE);
        self.level[SOURCE as usize] = 0;
        let mut queue = vec![SOURCE];
        let mut at = 0;
        while at < queue.len() {
            let node = queue[at];
            at += 1;
            let mut arc = self.heads[node as usize];
            while arc != NONE {
                let to = self.to[arc as usize] as usize;
                if self.capacity[arc as usize] > LEAST && self.level[to] == NONE {
                    self.level[to] = self.level[node as usize] + 1;
                    queue.push(to as u32);
                }
                arc = self.next[arc as usize];
            }
        }
        self.level[SINK as usize] != NONE
    }

    /// Pushes flow along one path of rising levels, depth first without recursion.
    fn augment(&mut self) -> f64 {
        let mut path: Vec<u32> = Vec::new();
        let mut node = SOURCE;
        loop {
            if node == SINK {
                let flow =
                    path.iter().map(|&a| self.capacity[a as usize]).fold(f64::INFINITY, f64::min);
                for &arc in &path {
                    self.capacity[arc as usize] -= flow;
                    self.capacity[arc as usize ^ 1] += flow;
                }
                return flow;
            }
            let arc = self.cursor[node as usize];
            if arc == NONE {
                // A dead end: step back and never come here again.
                let Some(last) = path.pop() else { return 0.0 };
                node = self.to[last as usize ^ 1];
                self.cursor[node as usize] = self.next[last as usize];
                continue;
            }
            let to = self.to[arc as usize];
            let rises = self.level[to as usize] == self.level[node as usize].wrapping_add(1);
            if rises && self.capacity[arc as usize] > LEAST {
                path.push(arc);
                node = to;
            } else {
                self.cursor[node as usize] = self.next[arc as usize];
            }
        }
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
