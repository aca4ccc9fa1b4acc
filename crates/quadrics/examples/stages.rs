//! One main stage on a fixed small mesh, by name: `benchmarks/instructions.py` counts what each takes.

use std::hint::black_box;

use quadrics::mesh::{Mesh, Working, repair};
use quadrics::prepare::{coarsen, in_own_cube};
use quadrics::synth::{self, Noise};
use quadrics::{Context, Options, format, segment};

/// Enough for every stage to do its usual work, and few enough for a simulated processor.
const FACES: usize = 6_000;

fn main() {
    let stage = std::env::args().nth(1).unwrap_or_default();
    let mesh = synth::part("demo", FACES).expect("the catalogue has it").mesh;
    match stage.as_str() {
        // What the others begin with.
        "nothing" => drop(black_box(mesh)),
        "read" => {
            let bytes = format::write("stl", &mesh).expect("a part fits into an STL");
            drop(black_box(format::read("stl", &bytes, &mut |_| None)));
        }
        "repair" => drop(black_box(repair(&mesh))),
        "order" => drop(black_box(in_own_cube(mesh))),
        "coarsen" => drop(black_box(coarsen(&Working::new(mesh), FACES / 4))),
        "segment" => segmented(&mesh),
        "segment_noisy" => {
            let noise = Noise::uniform(0.005, 0.9);
            let noisy = synth::add_noise(&mut Context::new(0), &mesh, &noise);
            segmented(&noisy.expect("the noise is in range"));
        }
        _ => {
            eprintln!("stages: name one of nothing, read, repair, order, coarsen, segment, ...");
            std::process::exit(2);
        }
    }
}

fn segmented(mesh: &Mesh) {
    let options = Options { threads: 1, ..Options::default() };
    drop(black_box(segment(&mut Context::new(0), mesh, &options, None)));
}
