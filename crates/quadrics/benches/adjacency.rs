//! `mesh/adjacency.rs`: which faces share an edge.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use quadrics::mesh::{Adjacency, NONE};
use quadrics::synth;

fn measure(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("adjacency");
    group.sample_size(10);
    for faces in [10_000, 100_000, 1_000_000] {
        let mesh = synth::part("demo", faces).expect("the catalogue has it").mesh;
        let vertices = mesh.positions.len();
        let found = Adjacency::new(&mesh.faces, vertices);
        assert!(found.neighbours.iter().flatten().all(|&other| other != NONE), "it is closed");
        group.throughput(Throughput::Elements(mesh.faces.len() as u64));
        group.bench_with_input(BenchmarkId::from_parameter(faces), &mesh, |bencher, mesh| {
            bencher.iter(|| Adjacency::new(&mesh.faces, vertices));
        });
    }
    group.finish();
}

criterion_group!(benches, measure);
criterion_main!(benches);
